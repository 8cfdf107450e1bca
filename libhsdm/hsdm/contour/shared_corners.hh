#pragma once
// Corners of three sheets of which one voxel's chain sees all, but which lie in another voxel.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/mesh/collapse_edges.hh"

namespace hsdm {

/// A chain with three sheets may have its corner in the next voxel, whose own chain has only one or two of
/// them. Then the edge between their two vertices should collapse to the corner. Not if the other chain has a
/// sheet that the first lacks (the far side of a thin part), a sheet that misses the corner, or a corner of
/// its own elsewhere; nor at borders. Returns the edges by ascending dual vertex, for each the best vertex to
/// move to the corner first. O(vertices.beyond).
std::vector<EdgeCollapse> shared_corners(const DualMesh& mesh, const PlacedVertices& vertices);

} // namespace hsdm
