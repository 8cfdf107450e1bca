#pragma once
// Facets -> OpenMesh and back. The only door between the flat facet lists and a half-edge mesh.

#include "hsdm/mesh_types.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

struct ToMeshResult {
    PolyMesh mesh;
    std::size_t rejected =
        0; ///< facets that would have broken the 2-manifold; 0 for what our own facet stages make
};

/// Builds the half-edge mesh. Every facet is checked before add_face sees it, so OpenMesh never prints;
/// vertex properties become named mesh properties (`hsdm_...`). Isolated vertices are left out.
ToMeshResult to_mesh(const PolygonMesh& facets);

/// The mesh's polygons, and its `hsdm_...` vertex properties of scalar type.
PolygonMesh to_polygons(const PolyMesh& mesh);

} // namespace hsdm
