#include "hsdm/pipeline/cloud_outliers.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/nth_of_all.hh"
#include "hsdm/pipeline/part_store.hh"
#include "hsdm/pipeline/stray_search.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// The neighbours in a part, and of which points they are those of the whole.
struct PartNeighbors {
    Neighbors neighbors;
    KnownPoints known;

    PartNeighbors(const CloudPart& part, int finest, PartStore& store)
        : neighbors(store.neighbors(part, {.finest_level = finest})), known(part.known_by(neighbors)) {}
};

ReachOfAll reach_of_all(ScratchCloud& cloud, const Survey& sums, std::span<const VoxelRange> ranges,
                        PartStore& store) {
    std::vector<float> squares; // as single precision has them, which reaches are roots of
    std::size_t volumes = 0, looked_at = 0;
    const std::size_t step = volume_stride(sums.points());
    const int finest = sums.finest_leaves();
    for_parts(cloud, sums, ranges, store.widths, [&](const CloudPart& part) {
        if (part.lacks_neighbors(NeighborOptions().count)) return false;
        const auto [neighbors, known] = PartNeighbors(part, finest, store);
        if (!known.all(part.begin(), part.end())) return false;
        for (std::size_t i = part.begin(); i < part.end(); ++i) {
            push_large(squares, static_cast<float>(neighbors.reach[i] * neighbors.reach[i]));
            if (part.number(i) % step != 0) continue;
            ++looked_at;
            volumes += fills_volume(part.octree(), neighbors, i);
        }
        return true;
    });
    const std::uint64_t points = cloud.ranks().sum(squares.size());
    const double typical = std::sqrt(static_cast<double>(nth_of_all(squares, points / 2, cloud.ranks())));
    return {typical, 2 * cloud.ranks().sum(volumes) > cloud.ranks().sum(looked_at)};
}

/// Those of all ranks that a round finds.
std::vector<PointRow> find_outliers(ScratchCloud& cloud, const Survey& sums,
                                    std::span<const VoxelRange> ranges, PartStore& store,
                                    const OutlierOptions& options) {
    const ReachOfAll all = reach_of_all(cloud, sums, ranges, store);
    const int finest = sums.finest_leaves();
    std::vector<PointRow> rows;
    for_parts(cloud, sums, ranges, store.widths, [&](const CloudPart& part) {
        if (part.lacks_neighbors(NeighborOptions().count)) return false;
        auto [neighbors, known] = PartNeighbors(part, finest, store);
        if (!known.all(part.begin(), part.end()) || !known.all_around(part.begin(), part.end())) return false;
        const std::vector<std::uint8_t> found = outliers_by_distance(part.octree(), neighbors, all, options);
        for (std::size_t i = part.begin(); i < part.end(); ++i)
            if (found[i]) rows.push_back(ScratchCloud::row_at(part.octree(), i));
        refuse_many_strays(rows.size());
        return true;
    });
    refuse_many_strays(cloud.ranks().sum(rows.size()));
    return values_of_all(cloud.ranks(), rows);
}

Occurrences occurrences(const std::vector<PointRow>& rows, const ScratchCloud& cloud) {
    const auto place = [](const PointRow& row) { return Vec3(row[0], row[1], row[2]); };
    const auto in_order = [&](const PointRow& row) {
        return std::pair(code_at(place(row), cloud.cube_extent()), row);
    };
    return {rows.size(), place(std::ranges::min(rows, {}, in_order)) + cloud.origin()};
}

} // namespace

Occurrences leave_outliers_out(ScratchCloud& cloud, CloudSurvey& survey, const PlanRanges& plan,
                               std::size_t most, PartStore& store, const OutlierOptions& options,
                               std::vector<PointRow>& out) {
    Occurrences total;
    for (int round = 0; round < options.rounds; ++round) {
        const std::vector<PointRow> some =
            find_outliers(cloud, survey.sums, plan(cloud, store.first_ghost), store, options);
        if (some.empty()) break;
        total.add(occurrences(some, cloud));
        append_large(out, some);
        refuse_many_strays(out.size());
        cloud.leave_out(out);
        const std::size_t left = survey.sums.points() - some.size();
        survey = survey_cloud(cloud, left, most);
        if (some.size() < left / 1000) break; // too few to have hidden others
    }
    return total;
}

} // namespace hsdm
