#pragma once
// Handles that no point speaks for: what the links of a grid face left of a web over a gap or a tunnel
// through a wall, by the mesh alone.

#include "hsdm/contour/mesh_of_part.hh"
#include "hsdm/contour/normal_sets.hh"
#include "hsdm/mesh/facet_links.hh"

#include <optional>

namespace hsdm {

struct HandleCounts {
    std::size_t cut = 0;     ///< rings
    bool looked_far = false; ///< of a part: behind a ring that it owns, beyond what is near
};

/// Cuts the mesh along short rings of edges that do not bound a small part of their own, and closes both
/// sides, where points pass across the ring and are missing along it, or none speak for a quarter of the
/// facets beside it, nor of those beside the rings next to it on average, or for one of a ring of three
/// edges, or its vertices are nearer to its axis than points to each other (Witnesses). A bridge through the
/// air is taken away like that, and a tunnel filled. Each cut raises the Euler characteristic by two, so it
/// comes to an end. A 2-manifold remains one; vertices are copied with their origins, `voxel` is per origin.
/// O(facets) a round, what takes long in parallel: rings are looked for near facets that no set of their
/// vertices' voxels agrees with, that face aside from one where a wall or gap passes, and where two short
/// edges of a facet meet; once some have been cut, within a few edges of these. `links` are the mesh's if
/// they are known; they are found if needed, and none are left once the mesh has changed.
HandleCounts cut_handles(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                         std::span<const Index> voxel, PolygonMesh& mesh, std::optional<FacetLinks>& links,
                         const PartVoxels& part = {});

} // namespace hsdm
