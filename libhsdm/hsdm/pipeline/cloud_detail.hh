#pragma once
// What of a cloud asks for finer voxels than its spacing.

#include "hsdm/contour/normal_sets.hh"
#include "hsdm/pipeline/choose_resolution.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// The detail of a level.
Detail detail_of(const Octree& octree, const OctreeLevel& level, const NormalSets& sets);

/// The same of the level of a cloud on disk. In one pass over tiles with so many voxels (two or more) around
/// them, none of which is of two ranks. For all ranks at the same time.
Detail detail_of(ScratchCloud& cloud, std::span<const VoxelRange> ranges, int ghost);

} // namespace hsdm
