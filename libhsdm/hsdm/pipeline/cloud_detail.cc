#include "hsdm/pipeline/cloud_detail.hh"

#include "hsdm/contour/bends.hh"
#include "hsdm/contour/sheet_widths.hh"
#include "hsdm/pipeline/constants.hh"

#include <algorithm>

namespace hsdm {
namespace {

Detail judged(std::size_t narrow, std::size_t voxels, const BendSums& bends) {
    return {static_cast<double>(narrow) > resolution::share_of_cylinders * static_cast<double>(voxels),
            bends.deviation() > resolution::widest_chord};
}

} // namespace

Detail detail_of(const Octree& octree, const OctreeLevel& level, const NormalSets& sets) {
    return judged(count_narrow_cylinders(octree, level, sets), level.size(),
                  measure_bends(sets, level.voxel_size, [](Index) { return true; }));
}

Detail detail_of(ScratchCloud& cloud, std::span<const VoxelRange> ranges, int ghost) {
    std::uint64_t narrow = 0, voxels = 0;
    BendSums bends;
    cloud.for_tiles(ranges, ghost, [&](const Octree& octree, const VoxelRange& range) {
        const OctreeLevel level = extract_level(octree, cloud.depth());
        const NormalSets sets = build_normal_sets(octree, level);
        const auto is_own = [&](Index voxel) { return range.holds(level.codes[voxel]); };
        const std::vector<Index> found = narrow_cylinders(octree, level, sets);
        narrow += static_cast<std::size_t>(std::ranges::count_if(found, is_own));
        voxels += static_cast<std::size_t>(
            std::ranges::count_if(level.codes, [&](MortonCode code) { return range.holds(code); }));
        const BendSums of_tile = measure_bends(sets, level.voxel_size, is_own);
        bends.points += of_tile.points, bends.squares += of_tile.squares;
    });
    for (std::uint64_t* const sum : {&narrow, &voxels, &bends.points, &bends.squares})
        *sum = cloud.ranks().sum(*sum);
    return judged(narrow, voxels, bends);
}

} // namespace hsdm
