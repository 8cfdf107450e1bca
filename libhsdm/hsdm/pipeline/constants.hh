#pragma once
// Tuning values of the pipeline. What half and double of each do: docs/constants.md.

#include "hsdm/core/tuned.hh"

namespace hsdm::resolution {

/// spacings: edge of the finest voxels of an adaptive grid.
/// Why: finer than spacings.spacings_per_voxel, for what they show where the error needs it; with two there
/// are four points a voxel.
HSDM_TUNED double adaptive_spacings = 2;

/// share: of the voxels, that bores or rods narrower than two of them pass, if voxels are as fine as that.
/// Why: a bore ten voxels long in a part of 20,000; where there is less of it the whole part is not made
/// finer.
inline constexpr double share_of_cylinders = 0.001;

/// voxels: the error bound of an adaptive grid that none is asked of.
/// Why: a tenth: what a uniform grid of such voxels keeps in the mean on curved ground.
inline constexpr double default_error = 0.1;

/// voxels: standard deviation of noise that need not be taken out of points with normals.
/// Why: beyond, noise decides topology; below, creases stay as crisp as they are.
HSDM_TUNED double harmless_noise = 0.3;

} // namespace hsdm::resolution

// which holes extended_method.hh closes; holes.widest of contour/constants.hh where voxels are wide against
// the spacing
namespace hsdm::holes {

/// spacings: wider loops stay open.
/// Why: by trial; a gap that the scanning left is to be closed, a window or a slot not.
HSDM_TUNED double widest_in_spacings = 20;

} // namespace hsdm::holes
