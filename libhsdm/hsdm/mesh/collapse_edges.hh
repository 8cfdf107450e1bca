#pragma once
// Edge collapses: two neighbouring vertices become one, at a new place.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

struct EdgeCollapse {
    Index from;    ///< becomes isolated
    Index to;      ///< takes its place in all facets
    Vec3 position; ///< of `to` afterwards
};

/// Collapses the edges, or diagonals of quads, one after the other; those refused are tried again after the
/// rest (16 rounds at most). If `to` was itself collapsed before, the vertex that replaced it takes over and
/// stays where it is. A facet that would be left without an area is united with the one across its longest
/// side if that side ends at the collapsed edge and the union is simple, of at most six corners. A 2-manifold
/// stays one of the same topology. An edge is refused, and nothing moves, unless exactly two facets have both
/// of its vertices, next to each other, or one quad has, opposite to each other; no further vertex is a
/// neighbour of both except through a triangle or that quad between them; one of the two is not on a border;
/// no vertex around loses its third facet; and every facet around keeps an area, its sides and its direction.
/// Returns per edge whether it was collapsed. O(corners of the mesh), nothing if there are no edges.
std::vector<std::uint8_t> collapse_edges(PolygonMesh& mesh, std::span<const EdgeCollapse> edges);

/// The same of edges whose ends lie at one place, so that no facet changes its shape: areas, sides and
/// directions are not asked, and a vertex keeps two facets.
std::vector<std::uint8_t> collapse_empty_edges(PolygonMesh& mesh, std::span<const EdgeCollapse> edges);

} // namespace hsdm
