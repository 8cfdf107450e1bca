#pragma once
// The normal of a polygon that need not be planar.

#include "hsdm/types.hh"

#include <cmath>

namespace hsdm {

/// Newell's area vector of a facet, taken relative to its first vertex so that nothing is lost far from the
/// origin: its direction is the facet's normal, the best plane of a warped quad; its length twice the area.
class AreaVector {
public:
    explicit AreaVector(const Vec3& first) : first_(first) {}
    /// The facet's other vertices, in order.
    void add(const Vec3& p) {
        const Vec3 arm = p - first_;
        sum_ += arm_ % arm;
        arm_ = arm;
    }
    const Vec3& operator*() const { return sum_; }

private:
    Vec3 first_;
    Vec3 arm_{0, 0, 0};
    Vec3 sum_{0, 0, 0};
};

/// The unit vector along v, or the zero vector for one without a direction.
inline Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0 && std::isfinite(length) ? v / length : Vec3(0, 0, 0);
}

/// Distance between the lines a-b and c-d: how far a quad with these diagonals is off a plane.
inline double line_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 across = (b - a) % (d - c);
    const double length = across.norm();
    return length > 0 ? std::abs(across | (c - a)) / length : 0;
}

/// Angle between two directions that need not be unit vectors, in [0, pi]; exact for small angles too.
inline double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2((a % b).norm(), a | b);
}

} // namespace hsdm
