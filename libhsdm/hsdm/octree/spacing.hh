#pragma once
// How densely a cloud samples its surface, found from the octree, and the depth that this density supports.

#include "hsdm/octree/constants.hh"
#include "hsdm/octree/octree.hh"

#include <string>

namespace hsdm {

/// Number of occupied voxels of every level, 0 to 21, in one pass over the sorted codes. O(n), parallel.
std::array<std::size_t, morton_levels + 1> count_voxels(const Octree& octree);

/// Mean distance between neighbouring points in the cloud's units: the side of the square of surface that
/// each point stands for. The area is taken from the finest level that still holds 8 points or more per
/// voxel: a surface in general pose crosses 1.5 A / h^2 voxels of edge h, less those clipped at a tip where
/// no point fell. Up to a quarter too small for axis-aligned planes (which cross A / h^2); meaningless for
/// points that fill a volume.
double estimate_spacing(const Octree& octree);

/// What the spacing follows from, which of parts of a cloud can be added up: of a part whose voxels of some
/// level are all of the part, from that level on.
struct VoxelCounts {
    std::array<std::size_t, morton_levels + 1> voxels{}; ///< of each level
    std::size_t places = 0; ///< points, those at one place once: they may have different normals
};
VoxelCounts count_places(const Octree& octree);
/// The same of a cube of this edge.
double estimate_spacing(const VoxelCounts& counts, double cube_extent);

/// An edge of the voxels and why.
struct VoxelChoice {
    double size = 0;    ///< in the cloud's units
    std::string reason; ///< one clause for a person
};

/// So many spacings, by default three: a surface in general pose then leaves few voxels empty by chance
/// (about six points per voxel). If that is more, twice the standard deviation of the noise (in the cloud's
/// units, 0 if there is none), below which nothing can be told from it. At most half the cube. The reason
/// gives lengths times `unit`.
VoxelChoice choose_voxel(const Octree& octree, double spacing, double noise, double unit = 1,
                         double spacings_per_voxel = spacings::spacings_per_voxel);

/// A depth and why.
struct DepthChoice {
    int depth = 1;
    std::string reason; ///< one clause for a person
};

/// The finest depth in [1, 16] whose voxels are at least so many spacings wide. The reason gives lengths
/// times `unit`.
DepthChoice choose_depth(const Octree& octree, double spacing,
                         double spacings_per_voxel = spacings::spacings_per_voxel, double unit = 1);

} // namespace hsdm
