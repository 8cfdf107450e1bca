#include "hsdm/pipeline/narrow_cylinders.hh"

#include "hsdm/contour/sheet_widths.hh"
#include "hsdm/pipeline/constants.hh"

#include <algorithm>

namespace hsdm {

bool has_narrow_cylinders(ScratchCloud& cloud, std::span<const VoxelRange> ranges, int ghost) {
    std::size_t narrow = 0, voxels = 0;
    cloud.for_tiles(ranges, ghost, [&](const Octree& octree, const VoxelRange& range) {
        const OctreeLevel level = extract_level(octree, cloud.depth());
        const std::vector<Index> found = narrow_cylinders(octree, level, build_normal_sets(octree, level));
        const auto is_own = [&](Index voxel) { return range.holds(level.codes[voxel]); };
        narrow += static_cast<std::size_t>(std::ranges::count_if(found, is_own));
        voxels += static_cast<std::size_t>(
            std::ranges::count_if(level.codes, [&](MortonCode code) { return range.holds(code); }));
    });
    const auto all = static_cast<double>(cloud.ranks().sum(voxels));
    return static_cast<double>(cloud.ranks().sum(narrow)) > resolution::share_of_cylinders * all;
}

} // namespace hsdm
