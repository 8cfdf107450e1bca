#pragma once
// Quads that are triangles by their shape, beside creases.

#include "hsdm/mesh/vertex_class.hh"
#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// Where a crease passes the corner of a quad straight on, the quad is a triangle by its shape, and where
/// quads were cut along a crease, triangles are left in pairs. The vertex opposite to such a corner, or at
/// the other end of the edge between two triangles, goes into the one on the crease, which stays where it is;
/// the quads round it then reach the crease. So does one of a crease into a corner. Not if the way leaves the
/// plane of a facet round it by more than `tolerance` (the mesh's units), or one of them were left with a
/// corner of less than 12 degrees or more than 168, or the vertex lies on a border. Of those that share a
/// facet the shortest way comes first. `classes`: per origin of a vertex. Returns how many vertices went.
/// O(facets); parallel until such corners are found.
std::size_t collapse_flat_corners(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh);

} // namespace hsdm
