#pragma once
// Sets that end at walls and gaps thinner than a voxel: coplanar patches with something between them are not
// one. See docs/sheets.md.

#include "hsdm/contour/set_relation.hh"

namespace hsdm {

struct PatchCounts {
    std::size_t crowded = 0; ///< voxels near two sheets that face each other or turn their backs
    std::size_t split = 0;   ///< patches beyond the first of a set
    std::size_t apart = 0;   ///< pairs of sets that are told apart
};

/// Splits sets at the walls and gaps that pass between their points, and notes in `sets.apart` which sets of
/// neighbouring voxels have one between them, so that RelationTest relates them no more. A wall or gap is a
/// pair of opposite sheets less than a voxel and a half apart; its middle surface parts what lies on its two
/// sides where both sheets end: on the ground of a wall, at the mouth of a gap. Its own rim is not split.
/// The rule is the same for walls and gaps with all normals turned. O(sets), parallel.
PatchCounts separate_patches(const Octree& octree, const OctreeLevel& level, const RelationTest& related,
                             NormalSets& sets);

} // namespace hsdm
