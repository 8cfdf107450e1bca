#pragma once
// Code -> position in a sorted array of codes, by open addressing: neighbour search in O(1).

#include "hsdm/octree/morton.hh"
#include "hsdm/types.hh"

#include <bit>
#include <vector>

namespace hsdm {

class MortonIndex {
public:
    /// The codes must be different from each other. O(n).
    void build(const std::vector<MortonCode>& codes) {
        const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * codes.size(), 2 * siblings));
        slots_.assign(slots, Slot{0, no_index});
        shift_ = 64 - std::countr_zero(slots / siblings);
        for (std::size_t i = 0; i < codes.size(); ++i) {
            std::size_t slot = slot_of(codes[i]);
            while (slots_[slot].position != no_index) slot = (slot + 1) & (slots - 1);
            slots_[slot] = {codes[i], static_cast<Index>(i)};
        }
    }
    /// Position of a code, or no_index.
    Index find(MortonCode code) const {
        if (slots_.empty()) return no_index;
        std::size_t slot = slot_of(code);
        while (slots_[slot].position != no_index && slots_[slot].code != code)
            slot = (slot + 1) & (slots_.size() - 1);
        return slots_[slot].position;
    }

private:
    struct Slot {
        MortonCode code;
        Index position;
    };
    /// Fibonacci hashing of the parent's code: the high bits of the product are well mixed. Siblings lie side
    /// by side, as who asks for one soon asks for others.
    std::size_t slot_of(MortonCode code) const {
        return static_cast<std::size_t>((code / siblings * 0x9e3779b97f4a7c15ull) >> shift_) * siblings
               + code % siblings;
    }
    static constexpr std::size_t siblings = 8;

    std::vector<Slot> slots_; // a power of two, load at most one half
    int shift_ = 0;
};

} // namespace hsdm
