#pragma once
// Which side of a plane or a line a point lies on, decided exactly.

#include "hsdm/types.hh"

#include <array>

namespace hsdm {

/// Sign of the determinant of b - a, c - a, d - a: 1 if a, b, c run anticlockwise seen from d, -1 if
/// clockwise, 0 if the four lie in one plane. Exact for finite coordinates whose products neither overflow
/// nor underflow: double arithmetic where its error bound allows, then long double, then expansions.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// A point of a coordinate plane.
using Vec2 = std::array<double, 2>;

/// The same in the plane: 1 if a, b, c run anticlockwise, 0 if they lie on a line.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

} // namespace hsdm
