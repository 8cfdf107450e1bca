#pragma once
// The tolerance envelope of a surface: which places lie on it, within a tolerance.

#include "hsdm/simplify/content_keys.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <atomic>

namespace hsdm {

/// Answers are remembered, because most places of one mesh are in the next too.
class ToleranceEnvelope {
public:
    /// `surface` must outlive this; about `places` answers are remembered, in 16 to 32 bytes each.
    ToleranceEnvelope(const SurfaceWalk& surface, double tolerance, std::size_t places);

    /// Is the place no more than the tolerance off the surface? `hint` as for SurfaceWalk. From any thread.
    bool holds(const Vec3& place, Index& hint);

    /// The result of `find()`, remembered by `key`. It must be below 16 and depend only on the surface and on
    /// what the key stands for. From any thread.
    template <class Find>
    unsigned remembered(Key key, const Find& find);

    const SurfaceWalk& surface() const { return surface_; }
    double tolerance() const { return tolerance_; }

private:
    const SurfaceWalk& surface_;
    double tolerance_;
    // hash table of a power of two slots: keys with the answer in their lowest bits
    std::vector<std::atomic<Key>> known_;
    int shift_;
};

template <class Find>
unsigned ToleranceEnvelope::remembered(Key key, const Find& find) {
    // slots to try; if all are taken by other keys the answer is not stored
    constexpr std::size_t most_steps = 8;
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
