#pragma once
// Tuning values of the pipeline. What half and double of each do: docs/constants.md.

#include "hsdm/core/tuned.hh"

namespace hsdm::resolution {

/// spacings: edge of the finest voxels of an adaptive grid.
/// Why: finer than spacings.spacings_per_voxel, for what they show where the error needs it; with two there
/// are four points a voxel.
HSDM_TUNED double adaptive_spacings = 2;

/// voxels: root mean square of what facets of the voxels cut off, from which on these are finer.
/// Why: what nine points leave of noise of a tenth of the spacing is as much; flatter surfaces gain nothing.
HSDM_TUNED double widest_chord = 0.01;

/// spacings: edge of the voxels then.
/// Why: six points a voxel, twice the three that a plane has parameters; facets cut off six tenths of that.
HSDM_TUNED double bent_spacings = 2.4;

/// share: of the voxels, that bores or rods narrower than two of them pass, if voxels are as fine as that.
/// Why: a bore ten voxels long in a part of 20,000; where there is less of it the whole part is not made
/// finer.
inline constexpr double share_of_cylinders = 0.001;

} // namespace hsdm::resolution

// which holes extended_method.hh closes; holes.widest of contour/constants.hh where voxels are wide against
// the spacing
namespace hsdm::holes {

/// spacings: wider loops stay open.
/// Why: by trial; a gap that the scanning left is to be closed, a window or a slot not.
HSDM_TUNED double widest_in_spacings = 20;

} // namespace hsdm::holes

// sparse_areas.hh
namespace hsdm::uneven {

/// points: per voxel that the surface passes; of fewer, voxels are too fine for it.
/// Why: one voxel in three is empty then by chance; with more, meshes close by themselves, and nearer to the
/// points.
inline constexpr double points_per_voxel = 1;

/// points: of the same; of fewer, voxels that were asked for are warned of.
/// Why: more than half are empty then. Of even spheres, tori and boxes, given normals or not, all six came
/// out right with 0.8, three with 0.6, none with 0.47.
inline constexpr double points_to_close = 0.6;

/// points: of the same, on the coarsest level that helps.
/// Why: by trial; nothing helps that level, so it has more.
inline constexpr double points_of_coarsest = 2;

/// points: of the same, the least that is told apart.
/// Why: a quarter: single points that stand alone in their window must not count as a large area.
inline constexpr double fewest_points = 0.25;

/// levels: above the voxels, whose voxels these are counted in.
/// Why: a surface passes some 100 voxels of the 512 in one. With 2 slivers of even clouds count, too.
inline constexpr int window_levels = 3;

/// points: in such a window; with fewer it is not looked at.
/// Why: outliers stand alone in theirs; a surface of half a point a voxel leaves some 50.
inline constexpr double fewest_of_window = 8;

/// share: of the surface, that may have fewer points than that.
/// Why: by trial; the borders of single scans have 2 %.
inline constexpr double most_sparse = 0.03;

/// levels: coarser than the voxels that are asked for, at most.
/// Why: each is worth four times the density: 256.
inline constexpr int most_levels = 4;

/// points: in the 27 voxels round a place, facing alike; with fewer it is sparse.
/// Why: a plane has some 81 there at three spacings a voxel, 36 at two; these are fewer than the
/// half that a border leaves of it.
inline constexpr int points_around = 16;

} // namespace hsdm::uneven
