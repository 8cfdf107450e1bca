#pragma once
// Area of a plane inside a voxel: how much of a sheet, and so how many points, a voxel should hold.

#include "hsdm/types.hh"

#include <span>

namespace hsdm {

/// Points x with normal . x <= offset.
struct HalfSpace {
    Vec3 normal;
    double offset;
};

/// Area of the part of plane normal . x = offset (unit normal) inside the box [lo, lo + size]^3 and inside
/// every half-space.
double plane_area(const Vec3& normal, double offset, const Vec3& lo, double size,
                  std::span<const HalfSpace> clips);

} // namespace hsdm
