#include "hsdm/simplify/tolerance_envelope.hh"

#include <bit>

namespace hsdm {

ToleranceEnvelope::ToleranceEnvelope(const SurfaceWalk& surface, double tolerance, std::size_t places)
    : surface_(surface),
      tolerance_(tolerance),
      known_(std::bit_ceil(2 * places + 2)),
      shift_(64 - std::countr_zero(known_.size())) {}

bool ToleranceEnvelope::holds(const Vec3& place, Index& hint) {
    return remembered(place_key(place),
                      [&] { return unsigned{!surface_.is_beyond(place, tolerance_, hint)}; });
}

} // namespace hsdm
