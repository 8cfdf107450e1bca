#pragma once
// Corners that the chain of one voxel sees and another voxel holds.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/mesh/collapse_edges.hh"

namespace hsdm {

/// A chain that sees three sheets may have its corner in the next voxel, whose own chain sees but one or two
/// of them. Then the two vertices should become one, there: the edge between them collapses to the corner.
/// Not if the other chain has a sheet that the first does not see (the far side of a thin part), one that
/// passes the corner by, or a corner of its own elsewhere; nor at borders. By ascending dual vertex, the
/// likeliest vertex to take its place first. O(vertices.beyond).
std::vector<EdgeCollapse> shared_corners(const GridPoints& grid, const Crossings& crossings,
                                         const DualVertices& duals, double voxel_size,
                                         const PlacedVertices& vertices);

} // namespace hsdm
