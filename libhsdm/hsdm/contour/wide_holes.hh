#pragma once
// Holes that are wider than gaps of the sampling.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Where the middle of a hole is, and how many points should lie in the disc about it in which none does.
struct HoleMiddle {
    Vec3 position;
    double missing_points;
};

/// Of a boundary loop, by the density of the voxels around; borders cut some of these, so that too few are
/// missed rather than too many. More than chance leaves out: nobody saw a surface there, or there is none.
/// `voxel` is per origin of the mesh's vertices. Completed points count. O(points around).
HoleMiddle middle_of_hole(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                          const PolygonMesh& mesh, std::span<const Index> loop);

} // namespace hsdm
