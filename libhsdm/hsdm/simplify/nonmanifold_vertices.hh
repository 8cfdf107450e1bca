#pragma once
// Where a mesh that came from collapsing vertices is not a proper 2-manifold.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// The vertices, ascending, whose facets do not form one proper fan: ends of edges with more than two facets
/// or with two that run the same way, vertices with several fans, inner vertices of only two facets, corners
/// of facets without area or with a side without length. `doublets`: vertices that may have only two facets,
/// if it is not empty. O(corners log corners), parallel.
std::vector<Index> nonmanifold_vertices(const PolygonMesh& mesh, std::span<const std::uint8_t> doublets = {});

} // namespace hsdm
