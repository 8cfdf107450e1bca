#pragma once
// Numbers of a few indices, for work on a small part of something large.

#include "hsdm/core/hash.hh"
#include "hsdm/types.hh"

#include <cstdint>
#include <utility>
#include <vector>

namespace hsdm {

/// A number for each of some indices, in open addressing; emptied at once. Not for several threads.
class SmallTable {
public:
    void clear() {
        count_ = 0;
        if (++round_ == 0) slots_.assign(slots_.size(), {}), round_ = 1;
    }
    bool contains(Index key) const { return slots_[slot_of(key)].round == round_; }
    /// That of an index, or no_index.
    Index at(Index key) const {
        const Slot& slot = slots_[slot_of(key)];
        return slot.round == round_ ? slot.value : no_index;
    }
    /// Gives an index a number, if it has none yet; was there none?
    bool add(Index key, Index value) {
        Slot& slot = slots_[slot_of(key)];
        if (slot.round == round_) return false;
        slot = {key, value, round_};
        if (2 * ++count_ > slots_.size()) grow();
        return true;
    }

private:
    struct Slot {
        Index key = 0, value = 0;
        std::uint32_t round = 0; // of those that are taken, the table's
    };

    std::size_t slot_of(Index key) const {
        std::size_t i = hash_index(key) & (slots_.size() - 1);
        while (slots_[i].round == round_ && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
        return i;
    }
    void grow() {
        const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
        for (const Slot& slot : before)
            if (slot.round == round_) slots_[slot_of(slot.key)] = slot;
    }

    std::vector<Slot> slots_ = std::vector<Slot>(256); // a power of two, at most half full
    std::size_t count_ = 0;
    std::uint32_t round_ = 1;
};

} // namespace hsdm
