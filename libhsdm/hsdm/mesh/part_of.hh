#pragma once
// Some facets of a mesh as a mesh of their own.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The facets with these indices, in this order, over the positions that they use; without properties and
/// normals. `number`, if given, becomes per vertex of the mesh its index in the part, or no_index. O(vertices
/// of the mesh + facets of the part).
PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets,
                    std::vector<Index>* number = nullptr);

} // namespace hsdm
