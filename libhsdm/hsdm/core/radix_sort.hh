#pragma once
// Stable radix sorts of numbers and of (code, index) pairs.

#include "hsdm/core/morton.hh"
#include "hsdm/types.hh"

#include <cstdint>
#include <vector>

namespace hsdm {

struct CodeIndex {
    MortonCode code;
    Index index;
};

/// Sorts by the bits [low, high) of the code, least significant digit first, stable. O(n), parallel; one
/// buffer of the same size. A digit that is the same everywhere costs one counting pass and no move.
void radix_sort(std::vector<CodeIndex>& keys, int high, int low = 0);
/// The same of numbers by their own bits.
void radix_sort(std::vector<std::uint64_t>& keys, int high, int low = 0);

} // namespace hsdm
