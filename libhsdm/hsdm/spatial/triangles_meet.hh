#pragma once
// Whether two triangles of a mesh meet where they should not.

#include "hsdm/types.hh"

#include <array>

namespace hsdm {

/// A triangle by its corners and by vertex indices in which corners at one position are one vertex.
struct PlacedTriangle {
    std::array<Vec3, 3> corner;
    std::array<Index, 3> vertex;
};

/// Whether the corners lie on a line. Exact.
bool is_collinear(const std::array<Vec3, 3>& corner);

/// Whether two triangles, neither of them collinear, have a point in common beside the vertices and the edge
/// that they share: touching counts, a shared edge folded flat onto itself counts, the same three vertices
/// count. Exact.
bool triangles_meet(const PlacedTriangle& a, const PlacedTriangle& b);

} // namespace hsdm
