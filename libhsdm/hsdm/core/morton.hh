#pragma once
// Morton codes: the three coordinates of a voxel, bit by bit.
//
//   code   ... z2 y2 x2  z1 y1 x1  z0 y0 x0
//
// A code of level L has 3 L bits. The voxel of level L - 1 around it is code >> 3, so points sorted by the
// code of the deepest level are sorted for every level above it.

#include <array>
#include <bit>
#include <cstdint>

namespace hsdm {

using MortonCode = std::uint64_t;

/// Deepest level that a 64-bit code holds; also the quantisation that orders points inside a voxel.
inline constexpr int morton_levels = 21;

using VoxelCoord = std::array<std::int32_t, 3>;

namespace detail {
/// Spreads the low 21 bits so that two zero bits follow each: abc -> 00a00b00c.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x001f00000000ffffull;
    v = (v | v << 16) & 0x001f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    v = (v | v << 2) & 0x1249249249249249ull;
    return v;
}
/// The inverse of spread_bits.
constexpr std::uint64_t gather_bits(std::uint64_t v) {
    v &= 0x1249249249249249ull;
    v = (v ^ v >> 2) & 0x10c30c30c30c30c3ull;
    v = (v ^ v >> 4) & 0x100f00f00f00f00full;
    v = (v ^ v >> 8) & 0x001f0000ff0000ffull;
    v = (v ^ v >> 16) & 0x001f00000000ffffull;
    v = (v ^ v >> 32) & 0x1fffffull;
    return v;
}
} // namespace detail

/// Interleaves three coordinates, each in [0, 2^21).
constexpr MortonCode morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return detail::spread_bits(x) | detail::spread_bits(y) << 1 | detail::spread_bits(z) << 2;
}
constexpr MortonCode morton_encode(const VoxelCoord& c) {
    return morton_encode(static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                         static_cast<std::uint32_t>(c[2]));
}
constexpr VoxelCoord morton_decode(MortonCode code) {
    return {static_cast<std::int32_t>(detail::gather_bits(code)),
            static_cast<std::int32_t>(detail::gather_bits(code >> 1)),
            static_cast<std::int32_t>(detail::gather_bits(code >> 2))};
}

/// The code of the next voxel up or down an axis. It must have one: there the bits of the axis would wrap.
constexpr MortonCode morton_up(MortonCode code, unsigned axis) {
    const MortonCode bits = 0x1249249249249249ull << axis; // of the axis; a carry runs through all others
    return (((code | ~bits) + 1) & bits) | (code & ~bits);
}
constexpr MortonCode morton_down(MortonCode code, unsigned axis) {
    const MortonCode bits = 0x1249249249249249ull << axis;
    return (((code & bits) - 1) & bits) | (code & ~bits);
}

/// The first level at which two codes of level 21 lie in different voxels; morton_levels + 1 if equal.
inline int split_level(MortonCode a, MortonCode b) {
    return a == b ? morton_levels + 1 : morton_levels - (63 - std::countl_zero(a ^ b)) / 3;
}

} // namespace hsdm
