#pragma once
// Quads that are triangles in disguise, three of their corners in a line.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Cuts quads in two at a corner that is straight or reflex: seen along the area vector, its angle's sine is
/// below `least_sine`. Along a crease such quads are frequent, with two sides on it. Those whose new edge
/// would be one of other facets already stay; of several that would get the same one, the first is cut.
/// Vertices do not change, a 2-manifold remains one. Returns how many were cut. O(corners log corners).
std::size_t cut_straight_corners(PolygonMesh& mesh, double least_sine);

/// The same where rounding decides whether a quad is a triangle: at a corner that is straight to
/// quad_splitting::straight, the diagonal beside it the shorter one. Cut along that, as quads usually are, it
/// has one triangle next to no area, whose corner lies on the other one, and whether the facets round it pass
/// through that hangs on the last digit. Not where another facet has both ends of the new edge.
std::size_t cut_doubtful_quads(PolygonMesh& mesh);

} // namespace hsdm
