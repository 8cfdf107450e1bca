#pragma once
// Two neighbouring vertices made one, at a new place.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

struct EdgeCollapse {
    Index from;    ///< becomes isolated
    Index to;      ///< takes its place in all facets
    Vec3 position; ///< of `to` afterwards
};

/// Collapses the edges one after the other, those refused again after the rest (16 times at most); where `to`
/// has gone itself, the vertex in its place stands for it and stays where it is. A facet that would be left
/// without an area is united with the one across its longest side if that ends at the collapsed edge and the
/// union is simple, of at most six corners. A 2-manifold remains one of the same topology: an edge is left
/// alone, and nothing moves, unless exactly two facets have both of its vertices, next to each other, no
/// further vertex is a neighbour of both but through a triangle between, one of the two is no border's, no
/// vertex around loses its third facet, and every facet around keeps an area, its sides and its direction.
/// Returns per edge whether it was collapsed. O(corners of the mesh), nothing if there are no edges.
std::vector<std::uint8_t> collapse_edges(PolygonMesh& mesh, std::span<const EdgeCollapse> edges);

} // namespace hsdm
