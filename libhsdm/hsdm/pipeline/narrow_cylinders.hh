#pragma once
// Whether a cloud on disk asks for finer voxels, as PreparedCloud finds it in memory.

#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// Are bores or rods under two voxels wide more than a detail of the cloud's level? In one pass over tiles
/// with so many voxels (two or more) around them, none of which is of two ranks. For all ranks at the same
/// time.
bool has_narrow_cylinders(ScratchCloud& cloud, std::span<const VoxelRange> ranges, int ghost);

} // namespace hsdm
