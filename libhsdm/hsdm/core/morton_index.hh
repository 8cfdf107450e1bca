#pragma once
// Code -> position in a sorted array of codes, by open addressing: neighbour search in O(1).

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/morton.hh"

#include <atomic>
#include <bit>
#include <vector>

namespace hsdm {

class MortonIndex {
public:
    /// The codes must be different from each other. O(n), parallel; answers do not depend on who came first.
    void build(const std::vector<MortonCode>& codes) {
        const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * codes.size(), 2 * siblings));
        assign_large(slots_, slots, Slot{});
        shift_ = 64 - std::countr_zero(slots / siblings);
        for_chunks(codes.size(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) slots_[take_slot(codes[i], i)].code = codes[i];
        });
    }
    /// Position of a code, or no_index.
    Index find(MortonCode code) const {
        if (slots_.empty()) return no_index;
        std::size_t slot = slot_of(code);
        while (slots_[slot].place != 0 && slots_[slot].code != code) slot = (slot + 1) & (slots_.size() - 1);
        return slots_[slot].place - 1; // no_index where there is none
    }
    void prefetch(MortonCode code) const {
        if (!slots_.empty()) __builtin_prefetch(&slots_[slot_of(code)]);
    }

private:
    struct Slot {
        MortonCode code = 0;
        Index place = 0; // one more than the position, 0 in an empty slot
    };
    std::size_t take_slot(MortonCode code, std::size_t position) {
        for (std::size_t slot = slot_of(code);; slot = (slot + 1) & (slots_.size() - 1)) {
            Index empty = 0;
            if (std::atomic_ref(slots_[slot].place)
                    .compare_exchange_strong(empty, static_cast<Index>(position) + 1,
                                             std::memory_order_relaxed))
                return slot;
        }
    }
    /// Fibonacci hashing of the parent's code: the high bits of the product are well mixed. Siblings lie side
    /// by side, because they are often looked up together.
    std::size_t slot_of(MortonCode code) const {
        return static_cast<std::size_t>((code / siblings * 0x9e3779b97f4a7c15ull) >> shift_) * siblings
               + code % siblings;
    }
    static constexpr std::size_t siblings = 8;

    std::vector<Slot> slots_; // a power of two, load at most one half
    int shift_ = 0;
};

} // namespace hsdm
