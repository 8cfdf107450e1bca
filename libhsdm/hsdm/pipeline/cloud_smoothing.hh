#pragma once
// A noisy cloud's points moved onto their surface, of a cloud on disk, as smooth_known_noise() does it in
// memory.

#include "hsdm/normals/smooth_points.hh"
#include "hsdm/pipeline/cloud_outliers.hh"

#include <optional>

namespace hsdm {

/// Each point goes where it would in one piece, bit for bit, with normals if it has them; those that come to
/// lie between sheets are left out. What a step makes of a point hangs on those within a width that is known
/// (PlaneSmoothing), so each part is looked at with as much around it, once a step. `as_read` becomes the
/// points that are left, in the same cube where they were. The survey becomes that of what is left. Points
/// are read `most` or a cell's at a time; some 8 bytes of each of this rank's are kept. For all ranks at the
/// same time. Throws Error where a step reaches farther than tiles see, or as leave_outliers_out().
SmoothReport smooth_cloud(ScratchCloud& cloud, CloudSurvey& survey, double noise, const PlanRanges& plan,
                          std::size_t most, PartStore& store, std::optional<ScratchCloud>& as_read);

} // namespace hsdm
