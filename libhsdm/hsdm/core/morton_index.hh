#pragma once
// Code -> position in a sorted array of codes: neighbour search in O(1).

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/morton.hh"

#include <atomic>
#include <bit>
#include <cassert>
#include <vector>

namespace hsdm {

/// Codes that agree in all but their last six bits make a block, of 4 x 4 x 4 voxels. It is found by open
/// addressing; a code's position is that of the block's first one and the number of those in between.
class MortonIndex {
public:
    /// The codes must ascend. O(n), parallel; answers do not depend on who came first.
    void build(const std::vector<MortonCode>& codes) {
        const std::vector<Index> starts = indices_where(codes.size(), chunks::light, [&](Index i) {
            assert(i == 0 || codes[i - 1] < codes[i]);
            return i == 0 || codes[i] / cells != codes[i - 1] / cells;
        });
        const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * starts.size(), 2 * siblings));
        assign_large(blocks_, slots, Block{});
        shift_ = 64 - std::countr_zero(slots / siblings);
        for_each_index(starts.size(), chunks::usual, [&](Index k) {
            const std::size_t begin = starts[k], end = k + 1 < starts.size() ? starts[k + 1] : codes.size();
            Block& block = blocks_[take_slot(codes[begin] / cells, begin)];
            block.number = codes[begin] / cells;
            for (std::size_t i = begin; i < end; ++i) block.used |= bit_of(codes[i]);
        });
    }
    static constexpr std::size_t cells = 64; ///< of a block

    /// As std::popcount, which calls a function where the processor may not have an instruction for it.
    static Index count_bits(std::uint64_t bits) {
        bits -= bits >> 1 & 0x5555555555555555ull;
        bits = (bits & 0x3333333333333333ull) + (bits >> 2 & 0x3333333333333333ull);
        bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0full;
        return static_cast<Index>(bits * 0x0101010101010101ull >> 56);
    }

    struct Block {
        MortonCode number = 0;  // the codes without their last six bits
        std::uint64_t used = 0; // a bit for each code that there is; none in an empty slot
        Index first = 0;        // one more than the position of the first, 0 in an empty slot

        /// Position of a code that belongs to the block, or no_index.
        Index find(MortonCode code) const {
            const std::uint64_t bit = bit_of(code);
            return used & bit ? first - 1 + count_bits(used & (bit - 1)) : no_index;
        }
    };

    /// Position of a code, or no_index.
    Index find(MortonCode code) const { return block_at(code / cells).find(code); }
    /// The block of a number, for several codes of it; one without any if there is none.
    const Block& block_at(MortonCode number) const {
        static constexpr Block none;
        if (blocks_.empty()) return none;
        std::size_t slot = slot_of(number);
        while (blocks_[slot].first != 0 && blocks_[slot].number != number) slot = after(slot);
        return blocks_[slot];
    }

private:
    static constexpr std::size_t siblings = 8;

    static std::uint64_t bit_of(MortonCode code) { return std::uint64_t{1} << code % cells; }

    std::size_t take_slot(MortonCode number, std::size_t first) {
        for (std::size_t slot = slot_of(number);; slot = after(slot)) {
            Index empty = 0;
            if (std::atomic_ref(blocks_[slot].first)
                    .compare_exchange_strong(empty, static_cast<Index>(first) + 1, std::memory_order_relaxed))
                return slot;
        }
    }
    std::size_t after(std::size_t slot) const { return (slot + 1) & (blocks_.size() - 1); }
    /// Fibonacci hashing of the parent's number: the high bits of the product are well mixed. Siblings lie
    /// side by side, because they are often looked up together.
    std::size_t slot_of(MortonCode number) const {
        return static_cast<std::size_t>((number / siblings * 0x9e3779b97f4a7c15ull) >> shift_) * siblings
               + number % siblings;
    }

    std::vector<Block> blocks_; // a power of two, load at most one half
    int shift_ = 0;
};

} // namespace hsdm
