#pragma once
// A range of a level's voxels in Morton order, and what lies near it.

#include "hsdm/core/morton.hh"

#include <algorithm>

namespace hsdm {

/// Voxels of a level, whole cells of 2^cell_shift voxels along an edge. Voxels without points count as well.
struct VoxelRange {
    MortonCode begin = 0, end = 0; ///< codes of the level
    int depth = 0;                 ///< of the level
    int cell_shift = 0;

    bool holds(MortonCode voxel) const { return voxel >= begin && voxel < end; }

    /// Is some voxel of the range at most `reach` voxels from this one along every axis? O((reach / cell +
    /// 2)^3).
    bool is_near(const VoxelCoord& voxel, int reach) const {
        return any_cell_near(voxel, reach, [&](MortonCode first) { return holds(first); });
    }
    /// Are all voxels at most so far from it in the range?
    bool holds_around(const VoxelCoord& voxel, int reach) const {
        return !any_cell_near(voxel, reach, [&](MortonCode first) { return !holds(first); });
    }

    /// Does is(its first code) hold for some cell with a voxel that is at most so far? Cells as of this
    /// range.
    template <class Is>
    bool any_cell_near(const VoxelCoord& voxel, int reach, const Is& is) const {
        const std::int32_t last = (std::int32_t{1} << depth) - 1;
        VoxelCoord lo, hi;
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = std::max(0, voxel[k] - reach) >> cell_shift;
            hi[k] = std::min(last, voxel[k] + reach) >> cell_shift;
        }
        for (VoxelCoord c = lo; c[2] <= hi[2]; ++c[2])
            for (c[1] = lo[1]; c[1] <= hi[1]; ++c[1])
                for (c[0] = lo[0]; c[0] <= hi[0]; ++c[0])
                    if (is(morton_encode(c) << (3 * cell_shift))) return true;
        return false;
    }
};

} // namespace hsdm
