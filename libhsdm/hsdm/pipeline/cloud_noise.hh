#pragma once
// The noise of a cloud on disk, as noise_deviation() finds it in memory.

#include "hsdm/pipeline/cloud_survey.hh"

namespace hsdm {

struct CloudNoise {
    double deviation = 0; ///< in the cloud's units
    double relative = 0;  ///< as estimate_noise()
};

/// In one pass over tiles with so many voxels around them. None of
/// the ranges may be of two ranks. For all ranks at the same time. Throws Error where it takes a part of all
/// points to tell.
CloudNoise cloud_noise(ScratchCloud& cloud, const CloudSurvey& survey, std::span<const VoxelRange> ranges,
                       int ghost, int neighbors = NeighborOptions().count);

} // namespace hsdm
