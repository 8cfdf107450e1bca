#pragma once
// Weighted least-squares planes.

#include "hsdm/types.hh"

#include <array>

namespace hsdm {

/// Weighted sums of positions relative to some base near by, from which a plane follows.
struct PlaneSums {
    double weight = 0;
    Vec3 first{0, 0, 0};
    std::array<double, 6> second{}; ///< xx, yy, zz, xy, yz, zx

    void add(const Vec3& d, double w) {
        const double x = w * d[0], y = w * d[1], z = w * d[2];
        weight += w;
        first += Vec3(x, y, z);
        second[0] += x * d[0], second[1] += y * d[1], second[2] += z * d[2];
        second[3] += x * d[1], second[4] += y * d[2], second[5] += z * d[0];
    }
};

struct PlaneFit {
    Vec3 centroid{0, 0, 0}; ///< relative to the same base
    Vec3 normal{0, 0, 0};   ///< unit, of either sign; (0, 0, 0) if the points span no plane
    double variance = 0;    ///< mean squared distance from the plane
};

/// The plane with the least weighted sum of squared distances. O(1).
PlaneFit fit_plane(const PlaneSums& sums);

/// A plane by what follows from the points' covariance: a vector along its normal, the variance along that,
/// the trace, and the product of the other two eigenvalues' distances from the smallest, over the trace's
/// square: without these two the points span no plane.
PlaneFit plane_along(const Vec3& along, double variance, double trace, double gap);

} // namespace hsdm
