#pragma once
// Vertices at exactly the same position.

#include "hsdm/types.hh"

#include <vector>

namespace hsdm {

/// For each position the least index that has an equal one (-0.0 equals 0.0). O(n).
std::vector<Index> weld(const std::vector<Vec3>& positions);

} // namespace hsdm
