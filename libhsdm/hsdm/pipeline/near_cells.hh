#pragma once
// The cells with points around a range of them.

#include "hsdm/io/scratch_points.hh"
#include "hsdm/pipeline/voxel_range.hh"

#include <span>
#include <vector>

namespace hsdm {

/// Codes of those `cells`, ascending as they are, that a range of cells of their level holds, or that are at
/// most `reach` cells from one that it holds, with or without points. O(cells in a box around the range).
std::vector<MortonCode> cells_near(const VoxelRange& range, int reach,
                                   std::span<const ScratchPoints::Cell> cells);

} // namespace hsdm
