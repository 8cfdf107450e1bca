#pragma once
// A scanner that stands in a few places round a solid and sees what nothing hides.

#include "support/sample.hh"

namespace hsdm::support {

struct ScannerOptions {
    std::size_t points = 40000; ///< rays that would hit a sphere round the solid, from all positions
    int positions = 5;          ///< on a circle above the solid: nothing of it is seen from below
    double noise = 0; ///< standard deviation along the ray, times 1 / cos of the angle of incidence, up to 5
    double misalignment = 0; ///< standard deviation of the shift of each position's scan along each axis
    double outliers = 0;     ///< share of rays that return from anywhere before or behind the surface
    double holes = 0;        ///< radius of two balls about points of the surface, that return nothing
    std::uint64_t seed = 1;
};

/// What scanners at these places, farther from the origin than 1.5 * `radius`, see of a solid within `radius`
/// of it; without normals, with where they stood (the shift of a scan is not known). `options.positions` is
/// of no account. The same seed gives the same scan on every platform.
PointCloud scan_from(const std::vector<Vec3>& places, const Solid& solid, double radius,
                     const ScannerOptions& options = {});

/// The same of places on a circle above, four times `radius` from the origin.
PointCloud scan_from_above(const Solid& solid, double radius, const ScannerOptions& options = {});

} // namespace hsdm::support
