#pragma once
// Clouds and options that a fuzzer's bytes choose: what scanners deliver, and what breaks reconstructions.

#include "hsdm/reconstruct.hh"

#include <fuzzer/FuzzedDataProvider.h>

namespace hsdm::fuzz {

/// A few hundred points at most, in pieces: points, lines, lattices, planes, spheres, boxes, clusters, double
/// sheets, copies of points before; with normals, colours and scalars or without; with coordinates that are
/// not finite; times a power of two.
struct FuzzedCloud {
    PointCloud cloud;
    int exponent = 0; ///< of the power of two
};
FuzzedCloud cloud_from(FuzzedDataProvider& data);

/// Options in their ranges, rarely beyond. `exponent`: of the cloud's scale, which lengths follow.
ReconstructOptions options_from(FuzzedDataProvider& data, int exponent);

} // namespace hsdm::fuzz
