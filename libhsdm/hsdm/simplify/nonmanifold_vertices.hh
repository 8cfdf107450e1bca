#pragma once
// Where a mesh that came from collapsing vertices is no proper 2-manifold.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The vertices, ascending, at which facets do not make one proper fan: ends of edges with more than two
/// facets or two that run the same way, vertices with several fans, inner vertices of only two facets,
/// corners of facets without area or with a side without length. Empty for a mesh without such. O(corners log
/// corners), parallel.
std::vector<Index> nonmanifold_vertices(const PolygonMesh& mesh);

} // namespace hsdm
