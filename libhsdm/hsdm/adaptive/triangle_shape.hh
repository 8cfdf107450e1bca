#pragma once
// How well a triangle is shaped.

#include "hsdm/types.hh"

#include <cmath>

namespace hsdm {

constexpr double least_shape = 0.02; ///< no change of the facets makes thinner triangles than this

/// Twice the area, along the normal.
inline Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a) % (c - a);
}

/// 1 for an equilateral triangle, 0 for a flat one; `normal` as above.
inline double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    const double sides = (b - a).sqrnorm() + (c - b).sqrnorm() + (a - c).sqrnorm();
    return sides > 0 ? 2 * std::sqrt(3.0) * normal.norm() / sides : 0;
}
inline double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
    return triangle_shape(a, b, c, triangle_normal(a, b, c));
}

} // namespace hsdm
