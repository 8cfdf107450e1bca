#pragma once
// Phase 1 once more, with the points of a surface that no scanner saw.

#include "hsdm/completion/complete_surface.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// A cloud with the points that complete it: an octree of the same voxels, or more of them, whose planes go
/// on, and the level of the mesh. Completed points have no number as `source`.
struct CompletedCloud {
    Octree octree;
    OctreeLevel level;

    /// Per voxel: has it no point but completed ones?
    std::vector<std::uint8_t> completed_voxels() const;
    /// Per voxel: has it a measured point?
    std::vector<std::uint8_t> measured_voxels() const;
};

/// A cube of the same voxels that holds a box.
struct CubeOfVoxels {
    Vec3 origin; ///< least corner
    int depth;   ///< levels, down to the voxels
};
/// The cube with this least corner and so many levels of voxels, moved down by `shift` of their edge, and by
/// whole voxels and with more levels where it takes them.
CubeOfVoxels cube_around(const Box& box, const Vec3& origin, double voxel_size, int depth, double shift);

/// Adds points whose `source` is what is given, no_index or between_points; relative to the octree's origin,
/// to those of a level. The voxels are moved down by `shift` of their edge along all axes, [0, 1). O(n),
/// parallel.
CompletedCloud complete_cloud(const Octree& octree, const OctreeLevel& level, const CompletedPoints& points,
                              double shift = 0, Index source = no_index);

} // namespace hsdm
