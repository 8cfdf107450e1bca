#pragma once
// Hashes whose sums identify sets.

#include <cstdint>

namespace hsdm {

/// Mixes a vertex index well enough that sums of mixed indices tell vertex sets apart (splitmix64).
inline std::uint64_t hash_index(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return x ^ x >> 31;
}

} // namespace hsdm
