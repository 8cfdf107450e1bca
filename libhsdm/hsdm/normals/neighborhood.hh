#pragma once
// Shared by the fits at one point: its neighbours' positions relative to it, and how well a plane explains
// them.

#include "hsdm/core/vector_pair.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"

#include <array>

namespace hsdm {

/// Biweight: 1 on the plane, 0 from the tolerance on.
inline double closeness(double residual, double inverse_tolerance) {
    const double t = residual * inverse_tolerance, u = std::max(0.0, 1 - t * t);
    return u * u;
}
inline Double2 closeness(Double2 residual, double inverse_tolerance) {
    const Double2 u = 1 - square(residual * inverse_tolerance);
    return square(u > 0 ? u : Double2{});
}

/// Agreement of two normals, by their cosine: 1 for the same direction, 0 from 33 degrees on.
inline double agreement(double cosine) {
    return std::max(0.0, cosine * cosine - neighborhoods::least_agreement)
           / (1 - neighborhoods::least_agreement);
}
inline Double2 agreement(Double2 cosine) {
    return max_lanes(Double2{}, cosine * cosine - neighborhoods::least_agreement)
           / (1 - neighborhoods::least_agreement);
}

/// The neighbours of one point as seen from it.
class Neighborhood {
public:
    Neighborhood(const Octree& octree, const Neighbors& neighbors, Index point)
        : around_(neighbors.of(point)) {
        for (std::size_t k = 0; k < around_.size(); ++k)
            offsets_[k] = octree.positions[around_[k]] - octree.positions[point];
    }
    std::size_t size() const { return around_.size(); }
    Index point(std::size_t k) const { return around_[k]; }
    const Vec3& offset(std::size_t k) const { return offsets_[k]; }

private:
    std::span<const Index> around_;
    std::array<Vec3, 64> offsets_; // Neighbors holds 64 per point at most
};

} // namespace hsdm
