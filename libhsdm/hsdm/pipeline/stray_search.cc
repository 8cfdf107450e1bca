#include "hsdm/pipeline/stray_search.hh"

#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t most_strays = std::size_t{1} << 20; // that are kept in memory

} // namespace

void refuse_many_strays(std::size_t count) {
    if (count > most_strays) refuse_in_tiles("many points are off every surface");
}

bool fit_to_points_left(ScratchCloud& cloud, std::size_t most) {
    const Box left = cloud.box_of_points(most);
    if (!is_other_box(left, cloud.bounds())) return false;
    cloud.rearrange(left, left.extent(), cloud.depth(), most);
    return true;
}

StraySearch::StraySearch(const ScratchCloud& cloud, const CloudSurvey& survey)
    : CellPass(cloud, survey.sums.points()),
      sparse_(survey.sums.sparse()),
      finest_(survey.sums.finest_leaves()) {}

std::vector<double> StraySearch::look(const Octree& octree, const VoxelRange&) {
    std::vector<double> reach;
    found_ = strays_by_normals(octree, sparse_, {}, &reach, finest_);
    return reach;
}

void StraySearch::take(const Octree& octree, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        if (found_[i]) strays_.push_back(ScratchCloud::row_at(octree, i));
    refuse_many_strays(strays_.size());
}

StraySearch::Result StraySearch::leave_out(ScratchCloud& cloud, CloudSurvey& survey, std::size_t most) {
    Ranks& ranks = cloud.ranks();
    add_far_cells(cloud);
    refuse_many_strays(ranks.sum(strays_.size()));
    std::vector<PointRow> all = values_of_all(ranks, strays_);
    release(strays_);
    if (all.empty()) return {};
    const auto place = [](const PointRow& row) { return Vec3(row[0], row[1], row[2]); };
    const auto in_order = [&](const PointRow& row) {
        return std::pair(code_at(place(row), cloud.cube_extent()), row);
    };
    Result result{{all.size(), place(std::ranges::min(all, {}, in_order)) + cloud.origin()}};
    const std::size_t points = survey.sums.points() - all.size();
    cloud.leave_out(std::move(all));
    result.moved = fit_to_points_left(cloud, most);
    survey = survey_cloud(cloud, points, most);
    return result;
}

StraySearch::Result drop_strays(ScratchCloud& cloud, CloudSurvey& survey, std::span<const VoxelRange> ranges,
                                int ghost, std::size_t most) {
    StraySearch search(cloud, survey);
    cloud.for_tiles(ranges, ghost,
                    [&](const Octree& octree, const VoxelRange& range) { search.add(octree, range, ghost); });
    return search.leave_out(cloud, survey, most);
}

} // namespace hsdm
