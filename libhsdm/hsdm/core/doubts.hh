#pragma once
// What a stage is not sure of: how often, and where to look.

#include "hsdm/types.hh"

namespace hsdm {

struct Doubts {
    std::size_t count = 0;
    Vec3 first{0, 0, 0}; ///< where the first of them is; anything if there are none
};

} // namespace hsdm
