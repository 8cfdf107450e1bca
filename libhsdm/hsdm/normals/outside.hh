#pragma once
// Which side of a patch is outside, by the empty space around and inside an object.

#include "hsdm/normals/constants.hh"
#include "hsdm/normals/empty_space.hh"
#include "hsdm/normals/patches.hh"

#include <span>

namespace hsdm {

struct OutsideOptions {
    /// > 0: edge of the voxels of the empty space, at least so many spacings, so that it does not leak
    /// through a sampled surface
    double voxel_spacings = views::voxel_spacings;
    /// octree depth of these voxels at most, [1, 8]: the space is kept densely
    int deepest = views::deepest;
    /// not empty: the sky is asked for, and these are the sides of patches that see none of it, as
    /// sheets_beside; O(8^deepest) more
    std::span<const std::uint8_t> beside{};
};

struct OutsideView {
    std::vector<std::int8_t> votes; ///< per patch: +1 if its normal points to the outer of two regions, -1 if
                                    ///< to the inner, 0 if it does not see two (a thin part, an open surface)
    std::vector<SignedEdge>
        facing; ///< patches that see each other across a wall or a gap, and so are of opposite sides
    /// Per patch, if asked for: +1 if most of the sky is open in front of it and not behind it, -1 the other
    /// way round, else 0; weighed by the cosine
    std::vector<std::int8_t> sky;
    /// The same without patches on sheets beside each other that are open to the sky on both sides: those are
    /// a plate, or layers of a surface over a solid whose underside nobody scanned. Nor does what lies within
    /// two voxels of a convex edge tell anything, where the sky is open on several sides
    std::vector<std::int8_t> clear_sky;
};

/// Finds the connected regions of empty voxels. One that can be reached from outside the box is outside; a
/// sheet whose patches see two regions separates them, so the region one sheet further is inside, the one two
/// sheets further outside again. A patch that sees another sheet before any empty space faces that sheet. O(n
/// + 8^deepest).
OutsideView view_outside(const Octree& octree, const Patches& patches, double spacing,
                         const OutsideOptions& options = {});

// The steps of that, for a cloud whose parts are looked at one after the other.

/// The level of the voxels of the empty space.
int depth_of_space(double cube_extent, double spacing, const OutsideOptions& options = {});
/// The first thing that a patch sees along a direction.
struct Sight {
    Index region = no_index;   ///< empty space; no_index if there is none near or a sheet comes first
    Index patch = no_index;    ///< of that sheet
    VoxelCoord voxel{0, 0, 0}; ///< of the space
};
using Sights = std::array<Sight, 2>; ///< in front of a patch and behind it
/// Those of the patches `begin` to `end`. `level`: of the octree, as deep as the space, which is the whole
/// cloud's. No point farther off than depth_of_sight() voxels of it matters.
std::vector<Sights> look_around(const Octree& octree, const OctreeLevel& level, const EmptySpace& space,
                                const Patches& patches, double spacing, Index begin, Index end);
inline int depth_of_sight() {
    return views::steps / 2 + 2; // as steps are halves of a voxel, and a centroid lies anywhere in one
}
/// What the sights of all patches tell. `voxel_size`: of the space, where the sky is asked for.
OutsideView judge_sights(const EmptySpace& space, const std::vector<Sights>& seen, const Patches& patches,
                         double voxel_size, std::span<const std::uint8_t> beside = {});

} // namespace hsdm
