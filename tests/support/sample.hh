#pragma once
// Scans of solids: points even over the surface, with the faults of a scanner if asked for.

#include "hsdm/point_cloud.hh"
#include "support/solid.hh"

namespace hsdm::support {

struct SampleOptions {
    std::size_t points = 10000;
    std::uint64_t seed = 1;
    bool normals = true;
    double position_noise = 0; ///< standard deviation in the solid's units, along the normal
    double normal_noise = 0;   ///< standard deviation in radians
    double outliers = 0;       ///< share of the points spread through the bounding box grown by a tenth
};

/// The same seed gives the same scan on every platform. Throws std::invalid_argument if the solid has no
/// boundary to speak of.
PointCloud sample(const Solid& solid, const SampleOptions& options = {});

/// Binary little-endian PLY, doubles, with normals if the cloud has them. Throws Error.
void write_ply(const std::string& path, const PointCloud& cloud);

} // namespace hsdm::support
