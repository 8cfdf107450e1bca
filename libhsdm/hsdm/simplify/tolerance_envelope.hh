#pragma once
// Which places lie on a surface, within a tolerance.

#include "hsdm/simplify/content_keys.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <atomic>

namespace hsdm {

/// Remembers what it was asked: one mesh after the other has most places in common.
class ToleranceEnvelope {
public:
    /// `surface` must outlive it; `places`: about as many are remembered, in 16 to 32 bytes each.
    ToleranceEnvelope(const SurfaceWalk& surface, double tolerance, std::size_t places);

    /// Is the place no more than the tolerance off the surface? `hint` as for SurfaceWalk. From any thread.
    bool holds(const Vec3& place, Index& hint);

    /// What `find()` returns, below 16, which must follow from the surface and from what the key stands for.
    /// From any thread.
    template <class Find>
    unsigned remembered(Key key, const Find& find);

    const SurfaceWalk& surface() const { return surface_; }
    double tolerance() const { return tolerance_; }

private:
    const SurfaceWalk& surface_;
    double tolerance_;
    std::vector<std::atomic<Key>> known_; // a power of two: keys, their last bits the answer
    int shift_;
};

template <class Find>
unsigned ToleranceEnvelope::remembered(Key key, const Find& find) {
    constexpr std::size_t most_steps = 8; // past slots that others have: whatever finds none is asked again
    constexpr Key answer = 15, taken = 16;
    key = (key | taken) & ~answer;
    std::size_t slot = key >> shift_;
    for (std::size_t step = 0; step < most_steps; ++step, slot = (slot + 1) & (known_.size() - 1)) {
        Key there = known_[slot].load(std::memory_order_relaxed);
        if (there == no_key) {
            const unsigned found = find();
            known_[slot].compare_exchange_strong(there, key | found, std::memory_order_relaxed);
            return found;
        }
        if ((there & ~answer) == key) return static_cast<unsigned>(there & answer);
    }
    return find();
}

} // namespace hsdm
