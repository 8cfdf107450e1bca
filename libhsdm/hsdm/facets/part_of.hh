#pragma once
// Some facets of a mesh as a mesh of their own.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The facets with these indices, in their order, over the positions that they use; properties and normals
/// are left behind. O(vertices of the mesh + facets of the part).
PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets);

} // namespace hsdm
