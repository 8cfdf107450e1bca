#pragma once
// Some facets of a mesh as a mesh of their own.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The facets with these indices, in their order, over the positions that they use; properties and normals
/// are left behind. `number`, if given, becomes the place in the part of each vertex of the mesh, or
/// no_index. O(vertices of the mesh + facets of the part).
PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets,
                    std::vector<Index>* number = nullptr);

} // namespace hsdm
