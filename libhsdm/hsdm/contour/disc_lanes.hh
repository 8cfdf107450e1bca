#pragma once
// What is asked of 64 discs of middle_discs.hh at a time, in the widest lanes that the processor has.

#include <cstddef>
#include <cstdint>
#include <span>

namespace hsdm {

/// Discs whose answers make a word.
inline constexpr std::size_t discs_of_word = 64;

/// The same functions for lanes of one width. All widths say the same to the last bit: each lane does what
/// the others do, in one order, and no product is added without being rounded.
struct DiscLanes {
    /// A bit for each disc that a place is behind: the sign of normal | (place - middle), by its terms in
    /// this order. `discs`: six rows of 64, of the axes of their normals and of their middles.
    std::uint64_t (*behind)(const double* discs, const double* place);
    /// Of the marked discs those that a way may meet: no farther from its middle than half of its length and
    /// their radius, in single precision and so generously. `discs`: four rows of 64, of the axes of their
    /// middles and of their radii; `way`: the axes of its middle, and half of its length.
    std::uint64_t (*near_way)(const float* discs, std::uint64_t marked, const float* way);
};

/// Those that this processor has, the widest first.
std::span<const DiscLanes> disc_lanes();

} // namespace hsdm
