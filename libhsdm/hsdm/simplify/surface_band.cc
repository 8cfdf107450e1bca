#include "hsdm/simplify/surface_band.hh"

#include <bit>

namespace hsdm {

SurfaceBand::SurfaceBand(const SurfaceWalk& surface, double tolerance, std::size_t places)
    : surface_(surface),
      tolerance_(tolerance),
      known_(std::bit_ceil(2 * places + 2)),
      shift_(64 - std::countr_zero(known_.size())) {}

bool SurfaceBand::holds(const Vec3& place, Index& hint) {
    return remembered(place_key(place),
                      [&] { return unsigned{!surface_.is_beyond(place, tolerance_, hint)}; });
}

} // namespace hsdm
