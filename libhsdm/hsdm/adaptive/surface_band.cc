#include "hsdm/adaptive/surface_band.hh"

#include <algorithm>
#include <bit>

namespace hsdm {
namespace {

constexpr std::size_t most_steps = 8; // past slots that others have: whatever finds none is asked again

} // namespace

SurfaceBand::SurfaceBand(const MeshDistance& surface, double tolerance, std::size_t places)
    : surface_(surface),
      tolerance_(tolerance),
      known_(std::bit_ceil(2 * std::max(places, most_steps))),
      shift_(64 - std::countr_zero(known_.size())) {}

bool SurfaceBand::holds(const Vec3& place, Index& hint) {
    constexpr Key answer = 1, taken = 2;
    const Key key = (place_key(place) | taken) & ~answer;
    std::size_t slot = key >> shift_;
    for (std::size_t step = 0; step < most_steps; ++step, slot = (slot + 1) & (known_.size() - 1)) {
        Key there = known_[slot].load(std::memory_order_relaxed);
        if (there == no_key) {
            const bool held = !surface_.is_beyond(place, tolerance_, hint);
            known_[slot].compare_exchange_strong(there, key | Key{held}, std::memory_order_relaxed);
            return held;
        }
        if ((there & ~answer) == key) return there & answer;
    }
    return !surface_.is_beyond(place, tolerance_, hint);
}

} // namespace hsdm
