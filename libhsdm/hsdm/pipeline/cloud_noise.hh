#pragma once
// The noise of a cloud on disk, as noise_deviation() finds it in memory.

#include "hsdm/pipeline/cloud_outliers.hh"

namespace hsdm {

struct CloudNoise {
    double deviation = 0; ///< in the cloud's units
    double relative = 0;  ///< as estimate_noise()
};

/// How a cloud is gone through in parts.
struct CloudPasses {
    PlanRanges plan{};
    int ghost_voxels = 0;        ///< round the parts
    std::size_t most_points = 0; ///< that are read at a time where nothing is around them
};

/// In one pass over tiles, and one over each of the thinned clouds that it takes to tell. For all ranks at
/// the same time. Throws Error where neighbours are farther off than tiles see.
CloudNoise cloud_noise(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes);
/// That alone, which takes no thinned clouds.
double relative_noise(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes,
                      int neighbors = NeighborOptions().count);

} // namespace hsdm
