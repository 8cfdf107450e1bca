#pragma once
// Which places lie on a surface, within a tolerance.

#include "hsdm/adaptive/content_keys.hh"
#include "hsdm/quality/distance.hh"

#include <atomic>

namespace hsdm {

/// Remembers what it was asked: one mesh after the other has most places in common.
class SurfaceBand {
public:
    /// `surface` must outlive it; `places`: about as many are remembered, in 16 to 32 bytes each.
    SurfaceBand(const MeshDistance& surface, double tolerance, std::size_t places);

    /// Is the place no more than the tolerance off the surface? `hint` as for MeshDistance. From any thread.
    bool holds(const Vec3& place, Index& hint);

    const MeshDistance& surface() const { return surface_; }
    double tolerance() const { return tolerance_; }

private:
    const MeshDistance& surface_;
    double tolerance_;
    std::vector<std::atomic<Key>> known_; // a power of two: keys of places, their last bit the answer
    int shift_;
};

} // namespace hsdm
