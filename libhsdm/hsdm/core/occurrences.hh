#pragma once
// What a stage has to tell of, such as points it removed or sheets it is not sure of: how many, and where to
// look.

#include "hsdm/types.hh"

namespace hsdm {

struct Occurrences {
    std::size_t count = 0;
    Vec3 first{0, 0, 0}; ///< where the first of them was; anything if there were none

    /// Adds those of another pass.
    void add(const Occurrences& more) {
        if (count == 0) first = more.first;
        count += more.count;
    }
};

} // namespace hsdm
