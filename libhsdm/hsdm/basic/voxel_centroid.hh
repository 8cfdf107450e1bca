#pragma once
// Section 3.2.1, step (1): where the vertex of a voxel lies.

#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Centroid of the points of one voxel, relative to the octree's origin. Summed in the octree's order, so the
/// same bits come out for any order of the cloud's points. O(points of the voxel).
Vec3 voxel_centroid(const Octree& octree, const OctreeLevel& level, Index voxel);

/// One vertex per occupied voxel of the level, in voxel order. O(n), parallel.
std::vector<Vec3> voxel_centroids(const Octree& octree, const OctreeLevel& level);

} // namespace hsdm
