#include "hsdm/pipeline/stray_search.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t most_strays = std::size_t{1} << 20; // that are kept in memory

void refuse_many() {
    refuse_in_tiles("many points are off every surface");
}

/// The cloud in the cube of what is left of it, as fit_to_points() has it. Does that differ?
bool fit_to_points_left(ScratchCloud& cloud, std::size_t most) {
    const Box left = cloud.box_of_points(most);
    if (!is_other_box(left, cloud.bounds())) return false;
    cloud.rearrange(left, left.extent(), cloud.depth(), most);
    return true;
}

} // namespace

StraySearch::StraySearch(const ScratchCloud& cloud, const CloudSurvey& survey)
    : cloud_(cloud), sparse_(survey.sums.sparse()) {}

void StraySearch::add(const Octree& octree, const VoxelRange& range, int ghost) {
    std::vector<double> reach;
    const std::vector<std::uint8_t> strays = strays_by_normals(octree, sparse_, {}, &reach);
    const double seen = ghost * cloud_.voxel_size();
    const auto cell_of = [&](std::size_t i) {
        return octree.codes[i] >> 3 * (morton_levels - cloud_.cell_depth());
    };
    const int to_level = 3 * (cloud_.depth() - cloud_.cell_depth());
    widest_ = std::max(widest_, ghost);
    for (std::size_t begin = 0, end; begin < octree.size(); begin = end) {
        bool is_far = false;
        for (end = begin; end < octree.size() && cell_of(end) == cell_of(begin); ++end)
            is_far = is_far || reach[end] > seen;
        if (!range.holds(cell_of(begin) << to_level)) continue;
        if (is_far) far_cells_.push_back(cell_of(begin));
        for (std::size_t i = begin; i < end && !is_far; ++i)
            if (strays[i]) strays_.push_back(ScratchCloud::row_at(octree, i));
        if (std::max(strays_.size(), far_cells_.size()) > most_strays) refuse_many();
    }
}

/// Around cells that were put off, twice as far each time.
void StraySearch::look_farther(ScratchCloud& cloud) {
    const int to_level = 3 * (cloud.depth() - cloud.cell_depth());
    std::vector<std::uint64_t> ghosts = cloud.ranks().gather(static_cast<std::uint64_t>(widest_));
    for (int ghost = static_cast<int>(std::ranges::max(ghosts)); cloud.ranks().any(!far_cells_.empty());) {
        if ((ghost *= 2) > most_ghost_voxels) refuse_in_tiles("some points are far from all others");
        std::vector<VoxelRange> cells;
        for (const MortonCode cell : std::exchange(far_cells_, {}))
            cells.push_back({cell << to_level, (cell + 1) << to_level, cloud.depth(), to_level / 3});
        cloud.for_tiles(cells, ghost,
                        [&](const Octree& octree, const VoxelRange& cell) { add(octree, cell, ghost); });
    }
}

StraySearch::Result StraySearch::leave_out(ScratchCloud& cloud, CloudSurvey& survey, std::size_t most) {
    Ranks& ranks = cloud.ranks();
    look_farther(cloud);
    if (ranks.sum(strays_.size()) > most_strays) refuse_many();
    std::vector<PointRow> all;
    for (const Ranks::Bytes& got : ranks.gather(bytes_of(strays_)))
        append_large(all, ByteReader(got).take_rest<PointRow>());
    strays_ = {};
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
