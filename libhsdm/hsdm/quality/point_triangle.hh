#pragma once
// The point of one triangle nearest to a point.

#include "hsdm/types.hh"

#include <algorithm>
#include <array>

namespace hsdm {

struct NearestOfTriangle {
    Vec3 point;
    double squared_distance;
    std::array<double, 3> weights; ///< barycentric coordinates of the point
};

/// The foot of a point on a triangle's plane; false if it lies outside the triangle. O(1).
inline bool foot_inside(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, NearestOfTriangle& foot) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const Vec3 normal = ab % ac;
    const double area = normal.sqrnorm();
    // Barycentric coordinates times the area.
    const double v = (ap % ac) | normal, w = (ab % ap) | normal;
    if (!(area > 0 && v >= 0 && w >= 0 && v + w <= area)) return false;
    const Vec3 height = normal * ((ap | normal) / area);
    foot = {p - height, height.sqrnorm(), {(area - v - w) / area, v / area, w / area}};
    return true;
}

/// The nearest point. O(1). A triangle without area counts as its sides.
inline NearestOfTriangle nearest_of_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    NearestOfTriangle best;
    if (foot_inside(p, a, b, c, best)) return best;
    const auto on_side = [&](const Vec3& from, const Vec3& way) {
        const double length = way.sqrnorm();
        return length > 0 ? std::clamp(((p - from) | way) / length, 0.0, 1.0) : 0.0;
    };
    const double s = on_side(a, b - a), t = on_side(a, c - a), u = on_side(b, c - b);
    const Vec3 on_ab = a + (b - a) * s, on_ac = a + (c - a) * t, on_bc = b + (c - b) * u;
    best = {on_ab, (p - on_ab).sqrnorm(), {1 - s, s, 0}};
    if (const double d = (p - on_ac).sqrnorm(); d < best.squared_distance) best = {on_ac, d, {1 - t, 0, t}};
    if (const double d = (p - on_bc).sqrnorm(); d < best.squared_distance) best = {on_bc, d, {0, 1 - u, u}};
    return best;
}

} // namespace hsdm
