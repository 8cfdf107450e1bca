#pragma once
// Bores and rods that pass a voxel without showing on its faces: the interior ambiguity of a cell (E.
// Chernyaev, Marching Cubes 33, 1995), decided by the voxel's sets. See docs/sheets.md.

#include "hsdm/contour/dual_mesh.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The dual vertices of one chain: first .. end, more than one where it was cut.
struct ChainVertices {
    Index first, end;
    auto operator<=>(const ChainVertices&) const = default;
};

/// Two closed chains of one voxel, each the end of a bore or rod, that a tube through the voxel should join.
using InnerTunnel = std::array<ChainVertices, 2>;

/// Where two closed chains of one voxel go round the two ends of what is free of sets, or full, nothing ends
/// there: every set of the voxel faces the way from the middle of one chain to that of the other, or every
/// set faces away from it, and with those near by they lie all round it. Ascending, each chain once.
/// O(dual vertices).
std::vector<InnerTunnel> find_inner_tunnels(const DualMesh& dual, const OctreeLevel& level,
                                            const NormalSets& sets);

/// Takes away the facets round the vertices of each tunnel's chains and joins the two rings of vertices
/// around by a tube of quads (and triangles where one ring has more vertices). The chains' vertices stay,
/// isolated. A 2-manifold stays one: where the rings are not two apart nothing changes. Returns how many were
/// opened. O(facets), if there are any.
std::size_t open_inner_tunnels(std::span<const InnerTunnel> tunnels, PolygonMesh& mesh);

} // namespace hsdm
