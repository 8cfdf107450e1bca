#include "hsdm/mesh/weld.hh"

#include <bit>

namespace hsdm {
namespace {

/// The bits of a coordinate: equal means the same everywhere, NaN included, and -0.0 is 0.0.
std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x + 0.0);
}

bool same_position(const Vec3& a, const Vec3& b) {
    return bits(a[0]) == bits(b[0]) && bits(a[1]) == bits(b[1]) && bits(a[2]) == bits(b[2]);
}

std::uint64_t hash(const Vec3& p) {
    std::uint64_t h = 0;
    for (double x : p) {
        h ^= bits(x);
        h *= 0x9e3779b97f4a7c15ull;
        h ^= h >> 32;
    }
    return h * 0x9e3779b97f4a7c15ull;
}

} // namespace

std::vector<Index> weld(const std::vector<Vec3>& positions) {
    const std::size_t slots = std::bit_ceil(2 * positions.size() + 2); // open addressing, at most half full
    const int shift = 64 - std::countr_zero(slots);
    std::vector<Index> table(slots, no_index), first(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = hash(positions[i]) >> shift;
        while (table[slot] != no_index && !same_position(positions[table[slot]], positions[i]))
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == no_index) table[slot] = static_cast<Index>(i);
        first[i] = table[slot];
    }
    return first;
}

} // namespace hsdm
