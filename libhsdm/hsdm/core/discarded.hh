#pragma once
// What a stage has removed: how many, and where to look for it.

#include "hsdm/types.hh"

namespace hsdm {

struct Discarded {
    std::size_t count = 0;
    Vec3 first{0, 0, 0}; ///< where the first of them was; anything if there were none

    /// Adds what another pass has removed.
    void add(const Discarded& more) {
        if (count == 0) first = more.first;
        count += more.count;
    }
};

} // namespace hsdm
