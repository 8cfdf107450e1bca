#pragma once
// Tuning values of spacing, resolution and points far away. What half and double of each do:
// docs/constants.md.

#include "hsdm/core/tuned.hh"

#include <cstddef>

// spacing.hh
namespace hsdm::spacings {

/// points: of a voxel that a surface passes, that tell its height; more have no more say, a sheet of fewer in
/// the voxels round one is strays. So many there are in voxels of the level on which voxels are counted.
/// Why: eight tell a mean height to a third of the noise, and leave few of a surface's voxels without a
/// point; more see curvature and thin parts.
HSDM_TUNED double points_per_voxel = 8;

/// share: of the voxels that a surface crosses, times the root of the points per voxel, that holds none.
/// Why: measured: 0.14 at 9 points, 0.10 at 17, 0.06 at 32.
HSDM_TUNED double empty_share = 0.4;

/// spacings: edge of the voxel that suits the sampling.
/// Why: nine points a voxel, which fix a set's normal, while one voxel in seven is a sliver without any; by
/// trial.
HSDM_TUNED double spacings_per_voxel = 3;

/// spacings: from a place on a sheet to the nearest of its points, at most.
/// Why: six points are expected on either half of that disc; that none is has a chance of a four hundredth.
inline constexpr double beside = 2;

/// deviations: edge of the voxel that suits the noise.
/// Why: by trial; two sheets of one voxel are told apart by 0.3 of it, and noise reaches as far.
inline constexpr double noises_per_voxel = 2;

} // namespace hsdm::spacings

// far_outliers.hh
namespace hsdm::far_points {

/// points: one in so many is left out at either end of each axis for the box that most lie in; of more in
/// scraps between cuts nothing is cut.
/// Why: two percent: more garbage than scanners make.
inline constexpr std::size_t one_outer_in = 50;

/// boxes: that hold most points, across the cloud's box; of fewer nothing is far away. A quarter of it lies
/// between that box and a point that is far away. Also across the widest gap that is tried as a cut first.
/// Why: 4096: the octree's 21 levels still have nine for such a box. A quarter: an outlier on either side,
/// and as far again between.
inline constexpr double boxes_across = 1 << 12;

} // namespace hsdm::far_points
