#pragma once
// Section 3.2.2, Fig. 7 and 8: three tests that tell false facets, which are in the connectivity graph but
// not on the surface. Each stands alone; a facet is given by its vertices in the graph, in order.

#include "hsdm/basic/connectivity_graph.hh"

namespace hsdm {

/// Vector area of a facet of the graph: along its normal, by its area in length. O(vertices).
Vec3 facet_area(const ConnectivityGraph& graph, std::span<const Index> vertices);

/// Hit test: true facets lie on the object, false ones inside. True if the ray from the facet's centre along
/// its normal (which side that is follows from the order of the vertices) runs into an occupied voxel that
/// is a neighbour (by face, edge or corner) of one of the facet's voxels, and not one of them. O(1).
bool hits_neighbor_voxel(const OctreeLevel& level, const ConnectivityGraph& graph,
                         std::span<const Index> vertices);

/// Distance criterion: the greatest distance to the facet of its close points, those that lie in the voxels
/// it intersects. Of several candidates at an edge the true one has the least. O(close points).
double deviation_from_close_points(const Octree& octree, const OctreeLevel& level,
                                   const ConnectivityGraph& graph, std::span<const Index> vertices);

/// Angle comparison: the angle in (0, 2 pi] by which `previous`, turned about the edge from -> to on the side
/// its normal points to, reaches `candidate`. Of several candidates the outer one has the least. `candidate`
/// runs along the edge, `previous` against it. O(vertices).
double outer_angle(const ConnectivityGraph& graph, Index from, Index to, std::span<const Index> previous,
                   std::span<const Index> candidate);

} // namespace hsdm
