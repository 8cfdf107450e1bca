#include "hsdm/simplify/leaf_doublets.hh"

#include "hsdm/mesh/facet_unions.hh"
#include "hsdm/simplify/constants.hh"

#include <numeric>

namespace hsdm {
namespace {

std::size_t dissolve_once(PolygonMesh& mesh, std::vector<Index>& stands_for) {
    const VertexFacets at = facets_at_vertices(mesh);
    FacetUnions unions(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || !unions.is_free(f, g)) continue;
        std::vector<Index> ring = united_ring(mesh, f, g, v);
        // Two triangles back to back may be removed only if they are not all there is at their other
        // vertices.
        if (ring.empty() || (ring.size() < 3 && (at.count[ring.front()] < 3 || at.count[ring.back()] < 3)))
            continue;
        stands_for[v] = ring.front();
        unions.unite(f, g, std::move(ring));
    }
    return unions.apply(mesh);
}

} // namespace

std::vector<Index> dissolve_doublets(PolygonMesh& mesh) {
    std::vector<Index> stands_for(mesh.vertex_count());
    std::iota(stands_for.begin(), stands_for.end(), Index{0});
    for (int round = 0; round < leaf_doublets::most_rounds && dissolve_once(mesh, stands_for) > 0; ++round) {
    }
    for (Index& v : stands_for)
        while (stands_for[v] != v) v = stands_for[v];
    return stands_for;
}

std::vector<Index> drop_replaced(PolygonMesh& mesh, std::vector<Index>& stands_for) {
    std::vector<Index> kept, number(stands_for.size(), no_index);
    for (Index v = 0; v < stands_for.size(); ++v) {
        if (stands_for[v] != v) continue;
        number[v] = static_cast<Index>(kept.size());
        mesh.positions[kept.size()] = mesh.positions[v];
        kept.push_back(v);
    }
    mesh.positions.resize(kept.size());
    if (!mesh.origin.empty()) mesh.origin = picked(mesh.origin, kept);
    for (Index& v : mesh.corners) v = number[v];
    for (Index& v : stands_for) v = number[v];
    return kept;
}

} // namespace hsdm
