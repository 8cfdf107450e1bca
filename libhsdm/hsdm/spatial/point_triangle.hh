#pragma once
// The point of one triangle nearest to a point.

#include "hsdm/types.hh"

#include <algorithm>
#include <array>
#include <limits>

namespace hsdm {

struct NearestOfTriangle {
    Vec3 point;
    double squared_distance;
    std::array<double, 3> weights; ///< barycentric coordinates of the point
};

/// A triangle with precomputed terms, for the nearest points of many points.
class PreparedTriangle {
public:
    PreparedTriangle(const Vec3& a, const Vec3& b, const Vec3& c)
        : a_(a),
          ab_(b - a),
          ac_(c - a),
          normal_(ab_ % ac_),
          per_area_(reciprocal(normal_.sqrnorm())),
          towards_b_((ac_ % normal_) * per_area_),
          towards_c_((normal_ % ab_) * per_area_) {}

    bool has_area() const { return per_area_ > 0; }

    /// The foot of a point on the triangle's plane; false if it lies outside the triangle. O(1).
    bool foot_inside(const Vec3& p, NearestOfTriangle& foot) const {
        const Vec3 ap = p - a_;
        const double v = ap | towards_b_, w = ap | towards_c_;
        const bool inside = (v >= 0) & (w >= 0) & (v + w <= 1); // one branch: each alone is a toss-up
        if (!inside || !has_area()) return false;
        const Vec3 height = normal_ * ((ap | normal_) * per_area_);
        foot = {p - height, height.sqrnorm(), {1 - v - w, v, w}};
        return true;
    }

    /// The nearest point. O(1). A triangle without area counts as its sides.
    NearestOfTriangle nearest(const Vec3& p) const {
        NearestOfTriangle best;
        if (foot_inside(p, best)) return best;
        const auto on_side = [&](const Vec3& from, const Vec3& way) {
            const double length = way.sqrnorm();
            return length > 0 ? std::clamp(((p - from) | way) / length, 0.0, 1.0) : 0.0;
        };
        const Vec3 b = a_ + ab_, bc = ac_ - ab_;
        const double s = on_side(a_, ab_), t = on_side(a_, ac_), u = on_side(b, bc);
        const Vec3 on_ab = a_ + ab_ * s, on_ac = a_ + ac_ * t, on_bc = b + bc * u;
        best = {on_ab, (p - on_ab).sqrnorm(), {1 - s, s, 0}};
        if (const double d = (p - on_ac).sqrnorm(); d < best.squared_distance)
            best = {on_ac, d, {1 - t, 0, t}};
        if (const double d = (p - on_bc).sqrnorm(); d < best.squared_distance)
            best = {on_bc, d, {0, 1 - u, u}};
        return best;
    }

private:
    static double reciprocal(double x) { return x >= std::numeric_limits<double>::min() ? 1 / x : 0; }

    Vec3 a_, ab_, ac_, normal_;
    double per_area_;            // one over four times the area squared, 0 if there is none
    Vec3 towards_b_, towards_c_; // gradients of the barycentric coordinates
};

} // namespace hsdm
