#pragma once
// Handles that no point speaks for: what the links of a grid face left of a web over a gap or a tunnel
// through a wall, by the mesh alone.

#include "hsdm/contour/normal_sets.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Cuts the mesh along short rings of edges that do not bound a part of their own, and closes both sides,
/// where the data contradict at least half of the facets beside the ring: sets lie in their vertices' voxels,
/// and none of them has a plane there that faces the same way. A bridge through the air is taken away like
/// that, and a tunnel filled. Each cut raises the Euler characteristic by two, so it comes to an end. A
/// 2-manifold remains one; vertices are copied with their origins. `voxel`: per origin of the vertices.
/// Returns how many rings were cut. O(facets): rings are looked for
/// near facets that are contradicted, and no more of them once that has taken so much work.
std::size_t cut_handles(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                        std::span<const Index> voxel, PolygonMesh& mesh);

} // namespace hsdm
