#pragma once
// One of many values that are with several ranks.

#include "hsdm/core/ranks.hh"

namespace hsdm {

/// The one that would come after `below` others if all ranks' values were sorted; none is negative. For all
/// ranks at the same time.
float nth_of_all(const std::vector<float>& values, std::uint64_t below, Ranks& ranks);

} // namespace hsdm
