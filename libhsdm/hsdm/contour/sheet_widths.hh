#pragma once
// How far the two sheets of a wall or gap are from each other, against what their points can tell.

#include "hsdm/contour/normal_sets.hh"
#include "hsdm/core/doubts.hh"

#include <optional>

namespace hsdm {

/// Two sheets of one voxel that face each other or turn their backs.
struct SheetPair {
    double spacings; ///< from one to the other, in spacings of their points there
    Vec3 middle;     ///< relative to the octree's origin
};

/// The pair of a voxel's sets with the fewest spacings in between; nothing if none of them are opposed.
std::optional<SheetPair> nearest_pair(const OctreeLevel& level, const NormalSets& sets, Index voxel);

/// The voxels where walls or gaps that stand on something are nearer than `least` spacings: which of the
/// sheets ends there, and which passes on, is for more points to tell. To be called after separate_patches,
/// which finds what stands on something; walls that stand free have nothing to be confused with and are told
/// apart by their normals, however thin. O(sets), parallel.
Doubts crowded_sheets(const OctreeLevel& level, const NormalSets& sets, double least = widths::least);

} // namespace hsdm
