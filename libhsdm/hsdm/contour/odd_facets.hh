#pragma once
// Facets with an odd number of corners, two and two recut to quads.

#include "hsdm/mesh/vertex_class.hh"
#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// A facet with an odd number of corners is no quad, and no quads can be made of it alone; of two of them
/// that share a side, or of two and the quad between, they can. Recuts such facets, and those of six to ten
/// corners alone, to quads over the same vertices: of all ways the one whose sharpest or bluntest corner is
/// best. Only convex quads with no corner of less than 12 degrees or more than 168, and with a diagonal along
/// which they bend by less than 25 degrees. Sides that go or come bend by less, those that go between two
/// vertices on creases by less than 12, as the bluntest crease does. What goes or comes and the diagonals of
/// quads lie within twice `tolerance` (the mesh's units) of what they cross; new sides and diagonals are none
/// of another facet, and no vertex loses its third facet. Of those that have any of that in common the best
/// shaped comes first, in a few rounds. `classes`: per origin of a vertex. Vertices keep their places and
/// numbers; turned facets give the same. Returns how many facets were recut. O(n log n) in the odd facets,
/// O(facets) else; parallel.
std::size_t recut_odd_facets(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh);

} // namespace hsdm
