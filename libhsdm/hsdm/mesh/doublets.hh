#pragma once
// Doublets: two facets that share two sides in a row or more, with vertices between that no other facet has.

#include "hsdm/polygon_mesh.hh"

#include <functional>

namespace hsdm {

/// Merges the two facets around every inner vertex that has no third, if `expendable(vertex)`, or if the two
/// are folded onto each other by more than 107 degrees, so that they would intersect when cut into triangles.
/// The vertices stay, isolated. A 2-manifold stays one: doublets whose union would have fewer than three
/// corners or a vertex twice are left alone. Returns how many were merged. O(facets) for each time that a
/// merger leaves another doublet.
std::size_t merge_doublets(PolygonMesh& mesh, const std::function<bool(Index)>& expendable);

/// The same round the vertices `there` alone, folded or not.
std::size_t merge_doublets_at(PolygonMesh& mesh, const std::function<bool(Index)>& there);

/// Takes inner vertices that have no third facet out of both, where they lie on the straight way between the
/// two vertices next to them, off it by `tolerance` (the mesh's units) at most: cut into triangles, the two
/// facets would have one in common, of hardly any area, and whether they pass through each other there is a
/// matter of rounding. The vertices stay, isolated; a 2-manifold stays one, with as many facets, of three
/// corners at least. Not beside another vertex of two facets. Returns how many were taken out, the
/// same whatever the numbers of vertices. O(facets).
std::size_t drop_straight_vertices(double tolerance, PolygonMesh& mesh);

} // namespace hsdm
