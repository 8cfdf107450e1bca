#pragma once
// How far the two sheets of a wall or gap are from each other, against what their points can tell, and how
// far those of a bore or rod, against the voxels.

#include "hsdm/contour/normal_sets.hh"
#include "hsdm/core/occurrences.hh"

#include <optional>

namespace hsdm {

/// Two sheets that face each other or turn their backs.
struct SheetPair {
    double spacings; ///< from one to the other, in spacings of their points there
    Vec3 middle;     ///< relative to the octree's origin
};

/// The least distance of a voxel's sets from opposite ones in it or beside it, in spacings of all of these;
/// nothing if there are none.
std::optional<SheetPair> nearest_pair(const OctreeLevel& level, const NormalSets& sets, Index voxel);

/// The voxels where walls or gaps that stand on something are nearer than `least` spacings: which of the
/// sheets ends there, and which passes on, is for more points to tell. To be called after separate_patches,
/// which finds what stands on something; walls that stand free have nothing to be confused with and are told
/// apart by their normals, however thin. A voxel with no such voxel beside it does not count: there points
/// lie unevenly, for what is narrow goes on. O(sets), parallel.
Occurrences crowded_sheets(const OctreeLevel& level, const NormalSets& sets, double least = widths::least);

/// The voxels, ascending, with another one beside them, that a bore or a rod under two voxels in diameter
/// passes: two sheets face each other or turn their backs less than two voxels apart, and both turn round as
/// fast as such a cylinder. The few facets round it are one voxel's decision each, so finer voxels do better.
/// What is more than two voxels off a voxel says nothing of it. O(points), parallel.
std::vector<Index> narrow_cylinders(const Octree& octree, const OctreeLevel& level, const NormalSets& sets);
/// How many these are.
std::size_t count_narrow_cylinders(const Octree& octree, const OctreeLevel& level, const NormalSets& sets);

} // namespace hsdm
