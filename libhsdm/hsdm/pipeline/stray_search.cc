#include "hsdm/pipeline/stray_search.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

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
    : sparse_(survey.sums.sparse()), voxel_size_(cloud.voxel_size()), depth_(cloud.depth()) {}

void StraySearch::add(const Octree& octree, const VoxelRange& range, int ghost) {
    std::vector<double> reach;
    const std::vector<std::uint8_t> strays = strays_by_normals(octree, sparse_, {}, &reach);
    const double seen = ghost * voxel_size_;
    const int shift = 3 * (morton_levels - depth_);
    for_each_in_order(octree.size(), [&](std::size_t i) {
        if (!range.holds(octree.codes[i] >> shift)) return;
        if (reach[i] > seen) refuse_in_tiles("some points are far from all others");
        if (!strays[i]) return;
        if (strays_.size() == most_strays) refuse_many();
        strays_.push_back(ScratchCloud::row_at(octree, i));
    });
}

StraySearch::Result StraySearch::leave_out(ScratchCloud& cloud, CloudSurvey& survey, std::size_t most) {
    Ranks& ranks = cloud.ranks();
    if (ranks.sum(strays_.size()) > most_strays) refuse_many();
    std::vector<PointRow> all;
    for (const Ranks::Bytes& got : ranks.gather(bytes_of(strays_)))
        append_large(all, ByteReader(got).take_rest<PointRow>());
    strays_ = {};
    if (all.empty()) return {};
    Result result{{all.size(), Vec3(all[0][0], all[0][1], all[0][2]) + cloud.origin()}};
    const std::size_t points = survey.sums.points() - all.size();
    cloud.leave_out(std::move(all));
    result.moved = fit_to_points_left(cloud, most);
    survey = survey_cloud(cloud, points, most);
    return result;
}

StraySearch::Result drop_strays(ScratchCloud& cloud, CloudSurvey& survey, std::span<const VoxelRange> ranges,
                                int ghost, std::size_t most) {
    StraySearch search(cloud, survey);
    std::vector<ScratchCloud::Surroundings> own;
    for (const VoxelRange& range : ranges)
        if (cloud.owner_of(range) == cloud.ranks().rank()) own.push_back({range, ghost});
    cloud.fetch(own);
    for (const ScratchCloud::Surroundings& tile : own)
        if (const std::vector<PointRow> rows = cloud.rows_of(tile.range, ghost); !rows.empty())
            search.add(cloud.octree_of(rows), tile.range, ghost);
    return search.leave_out(cloud, survey, most);
}

} // namespace hsdm
