#pragma once
// Points so far from the others that one grid over all would be wasted on the space between.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Removes far outliers (with a single garbage coordinate, the finest voxels hold crowds of points). If all
/// but the outer two percent along each axis (of a sample) lie in a box smaller than 2^-12 of the cube,
/// points more than 2^10 of such boxes away are removed, unless they are a part: 64 points or more in a voxel
/// of some level, around which the voxel eight times as large holds hardly any others. The positions of the
/// other points are taken again from the cloud that the octree was built of, because near a far origin they
/// were rounded, and fitted to a cube and frame of their own. Returns how many were removed, and where in the
/// cloud. O(1) if nothing is far, else O(n log n).
Occurrences drop_far_outliers(Octree& octree, const PointView& cloud, CloudFrame& frame);

/// Where the spacing of the points is finer than the finest depth can follow, shortens the empty space
/// between parts (CloudFrame::cut_gaps): gaps along an axis of 2^-12 of the cube, then narrower ones too, to
/// about the extent of the largest part, though not below `least_gap` (in the cloud's units). What lies
/// between cuts is a part if it holds 64 points; others are removed if they are two percent of all points
/// together, and else nothing is cut: a lattice is no crowd of parts. The octree's positions are then those
/// of the frame. Returns how many went, and where in the cloud. O(1) if the spacing is not too fine, else O(n
/// log n) a round; rounds halve the gaps.
Occurrences cut_empty_space(Octree& octree, const PointView& cloud, CloudFrame& frame, double least_gap = 0);

} // namespace hsdm
