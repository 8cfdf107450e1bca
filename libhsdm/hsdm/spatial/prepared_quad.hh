#pragma once
// Feet of points on the two triangles of a quad, both at once.

#include "hsdm/core/lanes.hh"
#include "hsdm/spatial/point_triangle.hh"

namespace hsdm {

/// The triangles (a, b, c) and (a, c, d) with precomputed terms. Each says to the last bit what a
/// PreparedTriangle says.
class PreparedQuad {
public:
    PreparedQuad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) : a_(a) {
        Vectors to_b, to_c;
        for (unsigned k = 0; k < 3; ++k) {
            to_b[k] = Double2{b[k] - a[k], c[k] - a[k]};
            to_c[k] = Double2{c[k] - a[k], d[k] - a[k]};
        }
        normal_ = cross(to_b, to_c);
        const Double2 area = dot(normal_, normal_);
        per_area_ = area >= std::numeric_limits<double>::min() ? 1 / area : Double2{};
        towards_b_ = scaled(cross(to_c, normal_), per_area_);
        towards_c_ = scaled(cross(normal_, to_b), per_area_);
    }

    /// Calls found(triangle, foot) for the first (0) and for the second (1) triangle where the foot of a
    /// point on its plane lies inside of it (PreparedTriangle::foot_inside). O(1).
    template <class Found>
    void for_feet(const Vec3& p, Found&& found) const {
        Vectors ap;
        for (unsigned k = 0; k < 3; ++k) ap[k] = Double2{p[k] - a_[k], p[k] - a_[k]};
        const Double2 v = dot(ap, towards_b_), w = dot(ap, towards_c_);
        const unsigned inside = lanes_of_two(v >= 0) & lanes_of_two(w >= 0) & lanes_of_two(v + w <= 1)
                                & lanes_of_two(per_area_ > 0);
        if (inside == 0) return;
        const Vectors heights = scaled(normal_, dot(ap, normal_) * per_area_);
        for (unsigned t = 0; t < 2; ++t) {
            if (!(inside >> t & 1u)) continue;
            const Vec3 height(heights[0][t], heights[1][t], heights[2][t]);
            found(t, NearestOfTriangle{p - height, height.sqrnorm(), {1 - v[t] - w[t], v[t], w[t]}});
        }
    }

private:
    using Vectors = std::array<Double2, 3>; // of both triangles

    // As OpenMesh's vectors do it, so that rounding is the same.
    static Double2 dot(const Vectors& a, const Vectors& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    static Vectors cross(const Vectors& a, const Vectors& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Vectors scaled(const Vectors& a, Double2 by) { return {a[0] * by, a[1] * by, a[2] * by}; }

    Vec3 a_;
    Vectors normal_, towards_b_, towards_c_;
    Double2 per_area_;
};

} // namespace hsdm
