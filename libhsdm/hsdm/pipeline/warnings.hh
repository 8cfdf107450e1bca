#pragma once
// What a run warns of: the report's list of places where the surface may be wrong (docs/quality.md#warnings).

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/report.hh"

namespace hsdm {

/// The texts of `what` in the report.
namespace warning_of {
inline constexpr const char* intersections = "pairs of facets that pass through each other";
inline constexpr const char* crowded_sheets = "voxels with walls or gaps too narrow for the points there";
inline constexpr const char* sides = "pairs of points side by side whose normals face opposite ways";
inline constexpr const char* too_small = "voxels too small for the points there";
inline constexpr const char* beyond = "points farther from the mesh than max_error";
inline constexpr const char* wide_holes =
    "holes closed where points should lie, in a surface that stays open";
inline constexpr const char* open_loops = "boundary loops that stay open though all were to be closed";
} // namespace warning_of

/// Adds an entry to the report's list, unless there is no doubt. `doubts.first` lies in the frame.
void warn(const char* what, const Occurrences& doubts, const CloudFrame& frame, Report& report);

/// In the place of what was said of it before, if anything was.
void warn_anew(const char* what, const Occurrences& doubts, const CloudFrame& frame, Report& report);

} // namespace hsdm
