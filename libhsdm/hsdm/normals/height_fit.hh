#pragma once
// Heights over a plane as a quadratic function: how much a bent sheet tilts the plane that is fitted to it.

#include "hsdm/core/lanes.hh"

#include <array>

namespace hsdm {

/// Results for two sets of points at once, one in each lane.
struct HeightFit {
    /// Slope of the best quadratic at the origin less the slope of the best plane: how far the plane is off,
    /// and the error of that. 0 where the points do not determine six coefficients.
    std::array<Double2, 2> tilt{};
    Double2 variance{}; ///< expected |tilt|^2 if there were only noise, by the quadratic's residuals
};

/// Sums over points (x, y) with height z, best of about unit size, for both fits; for two sets of equally
/// many points at once, in the time of one. The lanes do not affect each other.
class HeightSums {
public:
    void add(Double2 x, Double2 y, Double2 z);
    /// Least squares. O(1).
    HeightFit fit() const;

private:
    static constexpr std::size_t terms = 6;           // 1, x, y, x x, x y, y y
    std::array<std::array<Double2, 5>, 5> moments_{}; // of x^i y^j, i + j <= 4
    std::array<Double2, terms> heights_{};            // of the terms times z
    Double2 squares_{};
};

inline void HeightSums::add(Double2 x, Double2 y, Double2 z) {
    const Double2 xx = x * x, xy = x * y, yy = y * y;
    moments_[0][0] += 1, moments_[1][0] += x, moments_[0][1] += y;
    moments_[2][0] += xx, moments_[1][1] += xy, moments_[0][2] += yy;
    moments_[3][0] += xx * x, moments_[2][1] += xx * y, moments_[1][2] += x * yy, moments_[0][3] += yy * y;
    moments_[4][0] += xx * xx, moments_[3][1] += xx * xy, moments_[2][2] += xx * yy;
    moments_[1][3] += xy * yy, moments_[0][4] += yy * yy;
    heights_[0] += z, heights_[1] += x * z, heights_[2] += y * z;
    heights_[3] += xx * z, heights_[4] += xy * z, heights_[5] += yy * z;
    squares_ += z * z;
}

} // namespace hsdm
