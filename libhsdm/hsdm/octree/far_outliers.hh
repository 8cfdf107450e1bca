#pragma once
// Points so far from the others that one grid over all of them would be for nothing else.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Removes outliers: one garbage coordinate, and the finest voxels hold crowds. All but the outer two percent
/// along each axis (of a sample) lie in a box less than 2^-12 of the cube; what is more than 2^10 of such
/// boxes from it goes, unless it is a part: 64 points or more in a voxel of some level, around which the
/// voxel eight times as large holds hardly any others. The others' positions are taken anew from the cloud
/// that the octree was built of, since near a far origin they were rounded, and fit their cube again, in a
/// frame of their own. Returns how many went, and where in the cloud. O(1) if nothing is far, else O(n log
/// n).
Discarded drop_far_outliers(Octree& octree, const PointCloud& cloud, CloudFrame& frame);

/// Where the spacing of the points is finer than the finest depth can follow, shortens the empty space
/// between parts (CloudFrame::cut_gaps): gaps along an axis of 2^-12 of the cube, then narrower ones too, to
/// about the extent of the largest part, though not below `least_gap` (in the cloud's units). What lies
/// between cuts is a part if it holds 64 points; others are removed if they are two percent of all points
/// together, and else nothing is cut: a lattice is no crowd of parts. The octree's positions are then those
/// of the frame. Returns how many went, and where in the cloud. O(1) if the spacing is not too fine, else O(n
/// log n) a round; rounds halve the gaps.
Discarded cut_empty_space(Octree& octree, const PointCloud& cloud, CloudFrame& frame, double least_gap = 0);

} // namespace hsdm
