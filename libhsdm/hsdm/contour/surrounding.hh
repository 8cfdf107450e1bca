#pragma once
// Directions across an axis: what lies all round it.

#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hsdm {

/// Two unit vectors across an axis, and the angles of others about it.
class Frame {
public:
    /// The axis need not be of unit length; if it has none all angles are 0.
    explicit Frame(const Vec3& axis) {
        unsigned least = 0;
        for (unsigned k : {1u, 2u})
            if (std::abs(axis[k]) < std::abs(axis[least])) least = k;
        Vec3 other(0, 0, 0);
        other[least] = 1;
        across_[0] = unit(axis % other);
        across_[1] = unit(axis % across_[0]);
    }

    double angle_of(const Vec3& d) const { return std::atan2(d | across_[1], d | across_[0]); }

private:
    std::array<Vec3, 2> across_;
};

/// The widest angle between neighbouring directions, in radians; a full turn if there are less than two.
/// Sorts them.
inline double widest_gap(std::vector<double>& angles) {
    if (angles.empty()) return 2 * std::numbers::pi;
    std::ranges::sort(angles);
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
    return widest;
}

} // namespace hsdm
