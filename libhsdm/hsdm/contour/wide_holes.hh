#pragma once
// Holes that were closed and are wider than gaps of the sampling.

#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Of the loops that were closed those about whose middle a disc is free that should hold more points than
/// chance leaves out: nobody saw a surface there, or there is none. `voxel` is per origin of the mesh's
/// vertices; the facets are those that `filled` tells of, at the end of the mesh. Completed points count.
Occurrences wide_holes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                       const PolygonMesh& mesh, const FillHolesCounts& filled);

} // namespace hsdm
