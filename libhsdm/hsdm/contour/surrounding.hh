#pragma once
// Directions across an axis: what lies all round it.

#include "hsdm/contour/facet_constants.hh"
#include "hsdm/core/constants.hh"
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

/// How many angles between neighbouring directions are too wide for what lies all round; one if there are
/// less than two. Sorts them.
inline int wide_gaps(std::vector<double>& angles) {
    if (angles.empty()) return 1;
    std::ranges::sort(angles);
    int wide = angles.front() + 2 * std::numbers::pi - angles.back() >= surrounding::widest_gap;
    for (std::size_t i = 1; i < angles.size(); ++i)
        wide += angles[i] - angles[i - 1] >= surrounding::widest_gap;
    return wide;
}

/// Are so many directions enough to say so, and leave no wide gap? Sorts them.
inline bool stand_round(std::vector<double>& angles) {
    return angles.size() >= 2 * points_of_plane && wide_gaps(angles) == 0;
}

} // namespace hsdm
