#pragma once
// How well a triangle is shaped.

#include "hsdm/types.hh"

#include <cmath>

namespace hsdm {

/// Twice the area, along the normal.
inline Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a) % (c - a);
}

/// 1 for an equilateral triangle, 0 for a flat one, by twice its area and the squares of its sides together.
inline double triangle_shape(double twice_area, double squares) {
    return squares > 0 ? 2 * std::sqrt(3.0) * twice_area / squares : 0;
}
inline double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
    return triangle_shape(triangle_normal(a, b, c).norm(),
                          (b - a).sqrnorm() + (c - b).sqrnorm() + (a - c).sqrnorm());
}

} // namespace hsdm
