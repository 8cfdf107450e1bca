#pragma once
// Outliers of a cloud on disk that has no normals, as drop_outliers_by_distance() finds them in memory.

#include "hsdm/pipeline/cloud_survey.hh"

namespace hsdm {

/// What sees to it that the points of a pass are few enough: ranges of a cloud with so many voxels around
/// each, none of two ranks.
using PlanRanges = std::function<std::vector<VoxelRange>(const ScratchCloud&, int ghost)>;

class PartStore;

/// Leaves them out, of which `out` becomes all; the survey becomes that of what is left. Points are read
/// `most` or a cell's at a time. Keeps 4 bytes of each point of this rank. Returns how many, the first in the
/// cloud's coordinates. For all ranks at the same time. Throws Error as for_parts().
Occurrences leave_outliers_out(ScratchCloud& cloud, CloudSurvey& survey, const PlanRanges& plan,
                               std::size_t most, PartStore& store, const OutlierOptions& options,
                               std::vector<PointRow>& out);

} // namespace hsdm
