#include "hsdm/mesh/doublets.hh"

#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/facet_unions.hh"

#include <algorithm>

namespace hsdm {
namespace {

std::size_t merge_once(PolygonMesh& mesh, const std::function<bool(Index)>& expendable) {
    const VertexFacets at = facets_at_vertices(mesh);
    FacetUnions unions(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || !unions.is_free(f, g)) continue;
        const Vec3 one = unit(area_vector(mesh, mesh.facet(f))),
                   other = unit(area_vector(mesh, mesh.facet(g)));
        if (!expendable(v) && (one | other) > angles::opposed) continue;
        UnitedFacets whole = united(mesh, at, v);
        // Beside another vertex of only two facets the union might be the reverse of a third facet.
        if (whole.ring.size() < 3
            || std::ranges::any_of(whole.ring, [&](Index u) { return at.count[u] == 2; }))
            continue;
        unions.unite(f, g, std::move(whole.ring));
    }
    return unions.apply(mesh);
}

} // namespace

std::size_t merge_doublets(PolygonMesh& mesh, const std::function<bool(Index)>& expendable) {
    std::size_t merged = 0;
    while (const std::size_t count = merge_once(mesh, expendable)) merged += count; // facets get fewer
    return merged;
}

} // namespace hsdm
