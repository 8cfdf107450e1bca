#pragma once
// How far flat facets as long as a voxel would cut off the bends of a surface.

#include "hsdm/contour/normal_sets.hh"

#include <functional>

namespace hsdm {

/// Sums over points, exact in any order: parts of a cloud add up to the same.
struct BendSums {
    std::uint64_t points = 0;
    std::uint64_t squares = 0; ///< of chords' errors in voxels, times `scale`

    static constexpr double scale = 1u << 31; // with at most a voxel each, for 2^32 points
    /// Root mean square of the chords' errors, in voxels.
    double deviation() const;
};

/// Of the sets in voxels that `counts` says yes to. The points of a set on a cylinder lie off their plane by
/// 1 / sqrt(5) of its `turn`, in root mean square; so do facets of that length that lie amid the surface.
/// Noise of positions does not count, as it does not turn normals one way. O(sets), parallel.
BendSums measure_bends(const NormalSets& sets, double voxel_size, const std::function<bool(Index)>& counts);

} // namespace hsdm
