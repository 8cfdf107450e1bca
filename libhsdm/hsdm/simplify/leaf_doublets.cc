#include "hsdm/simplify/leaf_doublets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/facet_unions.hh"
#include "hsdm/simplify/constants.hh"

#include <algorithm>

namespace hsdm {
namespace {

std::size_t dissolve_once(std::span<const std::uint8_t> stays, PolygonMesh& mesh,
                          std::vector<Index>& stands_for) {
    const VertexFacets at = facets_at_vertices(mesh);
    FacetUnions unions(mesh);
    for_each_in_order(mesh.vertex_count(), [&](std::size_t i) {
        const auto v = static_cast<Index>(i);
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || !unions.is_free(f, g)) return;
        UnitedFacets whole = united(mesh, at, v);
        std::vector<Index>& ring = whole.ring;
        if (!stays.empty() && std::ranges::any_of(whole.between, [&](Index u) { return stays[u] != 0; }))
            return;
        // Two triangles back to back may be removed only if they are not all there is at their other
        // vertices.
        if (ring.empty() || (ring.size() < 3 && (at.count[ring.front()] < 3 || at.count[ring.back()] < 3)))
            return;
        for (const Index u : whole.between) stands_for[u] = ring.front();
        unions.unite(f, g, std::move(ring));
    });
    return unions.apply(mesh);
}

} // namespace

std::vector<Index> dissolve_doublets(PolygonMesh& mesh, std::span<const std::uint8_t> stays) {
    std::vector<Index> stands_for = indices_below(mesh.vertex_count());
    for (int round = 0; round < enough_rounds && dissolve_once(stays, mesh, stands_for) > 0; ++round) {
    }
    for_each_in_order(stands_for.size(), [&](std::size_t i) {
        Index& v = stands_for[i];
        while (stands_for[v] != v) v = stands_for[v];
    });
    return stands_for;
}

std::vector<Index> drop_replaced(PolygonMesh& mesh, std::vector<Index>& stands_for) {
    std::vector<Index> kept, number = large_vector<Index>(stands_for.size(), no_index);
    for_each_in_order(stands_for.size(), [&](std::size_t v) {
        if (stands_for[v] != v) return;
        number[v] = static_cast<Index>(kept.size());
        mesh.positions[kept.size()] = mesh.positions[v];
        push_large(kept, static_cast<Index>(v));
    });
    mesh.positions.resize(kept.size());
    if (!mesh.origin.empty()) mesh.origin = gathered(mesh.origin, kept);
    const auto renumber = [&number](std::vector<Index>& vertices) {
        for_each_index(vertices.size(), chunks::light, [&](Index i) { vertices[i] = number[vertices[i]]; });
    };
    renumber(mesh.corners);
    renumber(stands_for);
    return kept;
}

} // namespace hsdm
