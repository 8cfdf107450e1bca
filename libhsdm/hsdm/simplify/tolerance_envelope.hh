#pragma once
// The tolerance envelope of a surface: which places lie on it, within a tolerance.

#include "hsdm/spatial/surface_walk.hh"

namespace hsdm {

struct ToleranceEnvelope {
    const SurfaceWalk& surface;
    double tolerance;

    /// Is the place no more than the tolerance off the surface? `hint` as for SurfaceWalk. From any thread.
    bool holds(const Vec3& place, Index& hint) const { return !surface.is_beyond(place, tolerance, hint); }
};

} // namespace hsdm
