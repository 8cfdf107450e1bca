#pragma once
// The noise of a cloud on disk, as noise_deviation() finds it in memory.

#include "hsdm/pipeline/cloud_survey.hh"

namespace hsdm {

/// Standard deviation, in the cloud's units, in one pass over tiles with so many voxels around them. None of
/// the ranges may be of two ranks. For all ranks at the same time. Throws Error where it takes a part of all
/// points to tell.
double cloud_noise(ScratchCloud& cloud, const CloudSurvey& survey, std::span<const VoxelRange> ranges,
                   int ghost);

} // namespace hsdm
