#pragma once
// Any oriented facets -> an oriented 2-manifold, possibly with boundary, before a half-edge mesh sees them.

#include "hsdm/mesh/facet_links.hh"

namespace hsdm {

/// What make_manifold had to change; all zero for a mesh that was an oriented 2-manifold before.
struct ManifoldCounts {
    std::size_t degenerate = 0;        ///< facets with fewer than three different vertices, removed
    std::size_t cancelled = 0;         ///< facets removed in pairs: the same vertices, opposite orientation
    std::size_t duplicates = 0;        ///< further facets over the vertices of another, removed
    std::size_t complex_edges = 0;     ///< edges with more than two facets, or two that run the same way
    std::size_t opened_edges = 0;      ///< half-edges of complex edges left without a partner: new boundary
    std::size_t split_vertices = 0;    ///< vertices added because a vertex had several fans
    std::size_t subdivided_edges = 0;  ///< edges halved because no split of vertices could part their facets
    std::size_t isolated_vertices = 0; ///< removed

    bool changed() const {
        return degenerate + cancelled + duplicates + complex_edges + split_vertices + isolated_vertices != 0;
    }
};

/// Makes the mesh an oriented 2-manifold: every edge has at most two facets, which run along it in opposite
/// directions; the facets around every vertex form one fan; no facet repeats a vertex or the vertices of
/// another; no vertex is isolated. Nothing moves; vertices added take over position, normal and properties.
///
/// 1. A facet that touches itself in a vertex is cut there. Facets over the same vertices with opposite
///    orientation cancel in pairs; of equal ones the first stays.
/// 2. The facets around an edge are ordered by angle and paired without crossing, each with one that runs the
///    other way; of the two ways to do so the flatter. What finds no partner becomes boundary.
/// 3. Each fan of a vertex but the first gets a vertex of its own.
///
/// A mesh whose every edge has as many facets one way as the other, so a closed one above all, has no
/// boundary afterwards either. O(facets) but for the few edges with more than two; the result does not depend
/// on the number of threads. 1 million quads take about 0.2 s.
ManifoldCounts make_manifold(PolygonMesh& mesh);

/// Is the mesh, whose links these are, an oriented 2-manifold, so that make_manifold() would change nothing?
/// O(corners), parallel.
bool is_manifold(const PolygonMesh& mesh, const FacetLinks& links);

/// Removes the vertices of no facet, and sharp edges that end there; the others keep their order. Returns how
/// many vertices. O(vertices).
std::size_t remove_isolated_vertices(PolygonMesh& mesh);

} // namespace hsdm
