#include "hsdm/contour/flat_facets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/doublets.hh"
#include "hsdm/mesh/facet_unions.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>
#include <tuple>

namespace hsdm {
namespace {

std::vector<Index> flat_facets(const Vec3& origin, const PolygonMesh& mesh) {
    return collected<Index>(mesh.facet_count(), chunks::quick,
                            [&](std::size_t begin, std::size_t end, std::vector<Index>& part) {
                                std::vector<Vec3> ring;
                                for (std::size_t f = begin; f < end; ++f) {
                                    ring.clear();
                                    for (const Index v : mesh.facet(f))
                                        ring.push_back(mesh.positions[v] + origin);
                                    if (has_no_area(ring)) part.push_back(static_cast<Index>(f));
                                }
                            });
}

/// Whichever way round the facet is.
EdgeCollapse side_of(const PolygonMesh& mesh, std::span<const Index> facet, std::size_t i) {
    const auto [to, from] = std::minmax(facet[i], facet[(i + 1) % facet.size()]);
    return {from, to, mesh.positions[to]};
}

double squared_length(const PolygonMesh& mesh, const EdgeCollapse& side) {
    return (mesh.positions[side.to] - mesh.positions[side.from]).sqrnorm();
}

/// The sides of a facet, the shortest first.
std::vector<EdgeCollapse> sides_by_length(const PolygonMesh& mesh, Index f) {
    std::vector<EdgeCollapse> sides;
    for (std::size_t i = 0; i < mesh.facet(f).size(); ++i) sides.push_back(side_of(mesh, mesh.facet(f), i));
    std::ranges::sort(sides, {}, [&](const EdgeCollapse& side) {
        return std::tuple(squared_length(mesh, side), side.to, side.from);
    });
    return sides;
}

std::size_t removed_vertices(const std::vector<std::uint8_t>& collapsed, PolygonMesh& mesh) {
    const auto count = static_cast<std::size_t>(std::ranges::count(collapsed, 1));
    if (count > 0) remove_isolated_vertices(mesh);
    return count;
}

std::size_t collapse_shortest(const std::vector<Index>& flat, PolygonMesh& mesh) {
    std::vector<EdgeCollapse> shortest;
    shortest.reserve(flat.size());
    for (const Index f : flat) shortest.push_back(sides_by_length(mesh, f)[0]);
    return removed_vertices(collapse_edges(mesh, shortest), mesh);
}

/// The sides whose ends lie at one place.
std::size_t collapse_empty(const Vec3& origin, const std::vector<Index>& flat, PolygonMesh& mesh) {
    std::vector<EdgeCollapse> empty;
    for (const Index f : flat)
        for (const EdgeCollapse& side : sides_by_length(mesh, f))
            if (mesh.positions[side.from] + origin == mesh.positions[side.to] + origin) empty.push_back(side);
    return removed_vertices(collapse_empty_edges(mesh, empty), mesh);
}

} // namespace

std::size_t unite_flat_facets(const Vec3& origin, PolygonMesh& mesh) {
    std::size_t count = 0;
    while (const std::size_t more = unite_across_longest(flat_facets(origin, mesh), mesh)) count += more;
    return count;
}

std::size_t collapse_flat_facets(const Vec3& origin, PolygonMesh& mesh) {
    std::size_t count = 0;
    std::vector<Index> touched; // origins of vertices that may lose their third facet; ascending
    const auto merge = [&] {
        const std::size_t merged = merge_doublets_at(
            mesh, [&](Index v) { return std::ranges::binary_search(touched, mesh.origin[v]); });
        if (merged > 0) remove_isolated_vertices(mesh);
        return merged;
    };
    for (std::size_t more = 1; more > 0; count += more) {
        const std::vector<Index> flat = flat_facets(origin, mesh);
        more = collapse_shortest(flat, mesh);
        if (more > 0) continue;
        for (const Index f : flat)
            for (const Index v : mesh.facet(f)) touched.push_back(mesh.origin[v]);
        sort_unique(touched);
        more = collapse_empty(origin, flat, mesh);
        if (more == 0) more = unite_across_longest(flat, mesh);
        if (more == 0 && !touched.empty()) more = merge();
    }
    return count;
}

} // namespace hsdm
