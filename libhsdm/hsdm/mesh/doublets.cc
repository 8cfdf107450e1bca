#include "hsdm/mesh/doublets.hh"

#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/facet_unions.hh"

#include <algorithm>

namespace hsdm {
std::size_t merge_doublets(PolygonMesh& mesh, const std::function<bool(Index)>& expendable) {
    const VertexFacets at = facets_at_vertices(mesh);
    FacetUnions unions(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || !unions.is_free(f, g)) continue;
        const Vec3 one = unit(area_vector(mesh, mesh.facet(f))),
                   other = unit(area_vector(mesh, mesh.facet(g)));
        if (!expendable(v) && (one | other) > doublets::folded_cosine) continue;
        std::vector<Index> ring = united_ring(mesh, f, g, v);
        // Beside another vertex of only two facets the union might be the reverse of a third facet.
        if (ring.size() < 3
            || std::any_of(ring.begin(), ring.end(), [&](Index u) { return at.count[u] == 2; }))
            continue;
        unions.unite(f, g, std::move(ring));
    }
    return unions.apply(mesh);
}

} // namespace hsdm
