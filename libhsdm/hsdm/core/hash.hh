#pragma once
// Hashes whose sums identify sets.

#include <bit>
#include <cstdint>

namespace hsdm {

/// Mixes a vertex index well enough that sums of mixed indices tell vertex sets apart (splitmix64).
inline std::uint64_t hash_index(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return x ^ x >> 31;
}

/// A hash of words in their order, the same on every machine. It tells results apart, and keeps no secrets.
class OrderedHash {
public:
    void add(std::uint64_t word) {
        value_ = (value_ ^ word) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 32; // what the product moved up reaches the low bits too
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0x243f6a8885a308d3u;
};

} // namespace hsdm
