#pragma once
// Which of some candidates are near, in the widest lanes that the processor has.

#include "hsdm/types.hh"

#include <array>
#include <span>

namespace hsdm {

/// The same functions for lanes of one width. All widths say the same to the last bit: each lane does what
/// the others do, in one order, and no product is added without being rounded. All arrays go on for so many
/// values as there are lanes at most after those that count.
struct NearLanes {
    static constexpr std::size_t most = 16;

    struct Candidates {
        std::array<const float*, 3> axes;
        std::size_t count;
    };
    struct Found {
        float* distance;      ///< squared, of all candidates
        Index* near;          ///< those within the limit, ascending
        float* near_distance; ///< of these
    };
    /// Finds the candidates within a squared distance of a point; returns how many.
    std::size_t (*find)(const Candidates& candidates, const std::array<float, 3>& point, float limit,
                        const Found& found);
    /// How many of `count` distances are within a limit, which those after them are not, up to a multiple of
    /// the most lanes.
    std::size_t (*count)(const float* distance, std::size_t count, float limit);
    /// Keeps, in order, those whose distance is within the limit; returns how many. Distances as for count().
    std::size_t (*keep)(const float* distance, std::size_t count, float limit, Index* near);
};

/// Those that this processor has, the widest first.
std::span<const NearLanes> near_lanes();

} // namespace hsdm
