#pragma once
// Facets with an odd number of corners, two and two recut to quads.

#include "hsdm/mesh/vertex_class.hh"
#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// A facet with an odd number of corners is no quad, and no quads can be made of it alone; of two of them
/// that share a side, or of two and the quad between, they can. Recuts such facets, and those of six and more
/// corners, to quads over the same vertices, where these come out convex with no corner of less than 12
/// degrees or more than 168, and no side that goes or diagonal that comes lies more than `tolerance` (the
/// mesh's units) off the other surface. Sides that bend by 25 degrees stay; between two vertices on creases
/// those that bend by 12, which is the bluntest crease. No vertex is left with two facets. Of those that have
/// a facet or an end of such a side in common the best shaped comes first, in a few rounds. `classes`: per
/// origin of a vertex. Vertices keep their places and numbers. Returns how many facets were recut.
/// O(facets), parallel.
std::size_t recut_odd_facets(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh);

} // namespace hsdm
