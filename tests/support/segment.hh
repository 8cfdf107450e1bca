// A straight piece of a sharp edge.
#pragma once

#include "hsdm/types.hh"

#include <algorithm>

namespace hsdm::support {

struct Segment {
    Vec3 from, to;
};

inline double distance(const Vec3& p, const Segment& s) {
    const Vec3 along = s.to - s.from;
    const double length = along.sqrnorm();
    const double t = length > 0 ? std::clamp(((p - s.from) | along) / length, 0.0, 1.0) : 0;
    return (p - s.from - along * t).norm();
}

} // namespace hsdm::support
