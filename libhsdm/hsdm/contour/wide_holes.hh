#pragma once
// Holes that are wider than gaps of the sampling.

#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// How many points should lie in the disc about the middle of a hole's vertices in which none does, by the
/// density of the voxels around. Borders cut some of these, so it is rather too few. `voxel` is per origin of
/// the mesh's vertices. O(points around).
double missing_points(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                      const PolygonMesh& mesh, std::span<const Index> hole);

/// Of the loops that were closed those about whose middle a disc is free that should hold more points than
/// chance leaves out: nobody saw a surface there, or there is none. `voxel` is per origin of the mesh's
/// vertices; the facets are those that `filled` tells of, at the end of the mesh. Completed points count.
Occurrences wide_holes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                       const PolygonMesh& mesh, const FillHolesCounts& filled);

} // namespace hsdm
