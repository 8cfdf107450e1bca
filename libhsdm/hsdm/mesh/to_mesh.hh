#pragma once
// Facets -> OpenMesh and back. The only door between the flat facet lists and a half-edge mesh.

#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh_types.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Changes that to_mesh() had to make.
struct ToMeshCounts {
    std::size_t rejected =
        0; ///< facets that would have broken the 2-manifold; 0 for what our own facet stages make
    std::size_t split_vertices =
        0; ///< vertices added where facets met in a vertex only: each fan has its own
};
/// The mesh and the counts in one.
struct ToMeshResult {
    PolyMesh mesh;            ///< an oriented 2-manifold
    std::size_t rejected = 0, ///< as ToMeshCounts
        split_vertices = 0;   ///< as ToMeshCounts
};

/// Builds the half-edge mesh: always an oriented 2-manifold, possibly with boundary. A facet is rejected if
/// it has fewer than three vertices, one of them twice or one that does not exist, or if it runs along an
/// edge in the direction an earlier facet already does (so a third facet at an edge, or one turned the wrong
/// way). A facet's vertices keep their order, vertices keep theirs; isolated vertices are left out, copies of
/// split vertices come last. Vertex properties become named mesh properties (`hsdm_...`), facets get their
/// normals. The status bit `feature` is set on the sharp edges and their ends, and on the vertices whose
/// `hsdm_vertex_class` is edge or corner. Nothing is printed. O(corners log valence), parallel. Throws Error
/// for normals that are not one for each vertex.
ToMeshResult to_mesh(const PolygonMesh& facets);
/// The same in place: fills an empty mesh, because OpenMesh meshes cannot be moved, only copied.
ToMeshCounts to_mesh(const PolygonMesh& facets, PolyMesh& mesh);
/// The same where the facets' links are known.
ToMeshCounts to_mesh(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh);

/// The mesh's polygons without deleted elements and isolated vertices; its vertex normals if it has them; its
/// named vertex properties of type uint8, int32, float and double; the edges with the status bit `feature`.
/// `hsdm_normals` comes as nine of type float, `hsdm_normals_0_x` to `hsdm_normals_2_z`; to_mesh puts them
/// together again. Parallel, O(corners).
PolygonMesh to_polygons(const PolyMesh& mesh);

} // namespace hsdm
