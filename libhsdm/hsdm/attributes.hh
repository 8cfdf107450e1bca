#pragma once
// Colours and further scalars of the points, carried to the vertices.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// A value per vertex v, the average over the points of voxel[v]: red, green, blue and alpha as uint8, every
/// scalar of the cloud under its own name; of labels the majority's (the least of those in a tie). Beside
/// them `hsdm_level`, the octree level. O(n) per attribute, parallel.
std::vector<VertexProperty> average_attributes(const PointCloud& cloud, const Octree& octree,
                                               const OctreeLevel& level, std::span<const Index> voxel);

} // namespace hsdm
