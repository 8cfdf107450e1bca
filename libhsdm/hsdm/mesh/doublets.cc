#include "hsdm/mesh/doublets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/edge_set.hh"
#include "hsdm/mesh/facet_unions.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Onto each other.
bool are_folded(const PolygonMesh& mesh, Index f, Index g) {
    const Vec3 one = unit(area_vector(mesh, mesh.facet(f))), other = unit(area_vector(mesh, mesh.facet(g)));
    return (one | other) <= angles::opposed;
}

enum class Folded : bool { stay, go };

std::size_t merge_once(PolygonMesh& mesh, const std::function<bool(Index)>& expendable, Folded folded) {
    const VertexFacets at = facets_at_vertices(mesh);
    FacetUnions unions(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || !unions.is_free(f, g)) continue;
        if (!expendable(v) && (folded == Folded::stay || !are_folded(mesh, f, g))) continue;
        UnitedFacets whole = united(mesh, at, v);
        // Beside another vertex of only two facets the union might be the reverse of a third facet.
        if (whole.ring.size() < 3
            || std::ranges::any_of(whole.ring, [&](Index u) { return at.count[u] == 2; }))
            continue;
        unions.unite(f, g, std::move(whole.ring));
    }
    return unions.apply(mesh);
}

/// A vertex with two facets, and the two vertices next to it, the lesser first.
struct Between {
    std::array<Index, 2> ends;
    Index vertex;
};

/// The corners before and after one in a ring.
std::array<Index, 2> beside(std::span<const Index> ring, Index v) {
    const auto at = static_cast<std::size_t>(std::ranges::find(ring, v) - ring.begin());
    return {ring[at == 0 ? ring.size() - 1 : at - 1], ring[at + 1 == ring.size() ? 0 : at + 1]};
}

bool is_between(const Vec3& p, const Vec3& a, const Vec3& b, double tolerance) {
    const Vec3 way = b - a;
    return ((p - a) | way) > 0 && ((b - p) | way) > 0 && (way % (p - a)).norm() <= tolerance * way.norm();
}

/// Vertices on the straight way between the only two next to them, which have more facets.
std::vector<Between> straight_ones(const PolygonMesh& mesh, const VertexFacets& at, double tolerance) {
    std::vector<Between> result;
    for_each_in_order(mesh.vertex_count(), [&](std::size_t i) {
        const auto v = static_cast<Index>(i);
        if (at.count[v] != 2) return;
        const auto [a, b] = beside(mesh.facet(at.facets[v][0]), v);
        if (at.count[a] == 2 || at.count[b] == 2
            || beside(mesh.facet(at.facets[v][1]), v) != std::array{b, a})
            return;
        if (is_between(mesh.positions[v], mesh.positions[a], mesh.positions[b], tolerance))
            result.push_back({{std::min(a, b), std::max(a, b)}, v});
    });
    return result;
}

/// Those whose ends no other edge joins, nor would the way of another one.
void keep_new_edges(const PolygonMesh& mesh, std::vector<Between>& straight) {
    std::vector<Index> ends;
    for (const Between& one : straight) ends.insert(ends.end(), one.ends.begin(), one.ends.end());
    const EdgeSet edges(mesh, ends);
    std::ranges::sort(straight, {}, &Between::ends);
    std::vector<Between> kept;
    for (std::size_t i = 0; i < straight.size(); ++i) {
        const auto& [ends_here, v] = straight[i];
        const bool twice = (i > 0 && straight[i - 1].ends == ends_here)
                           || (i + 1 < straight.size() && straight[i + 1].ends == ends_here);
        if (!twice && !edges.contains(ends_here[0], ends_here[1])) kept.push_back(straight[i]);
    }
    straight = std::move(kept);
}

/// Takes vertices out of the rings of all facets. Three corners are left to each: no two of these vertices
/// are next to each other; a triangle's third side would join the ends of one, and in a quad two have the
/// same ends.
void take_out(const std::vector<std::uint8_t>& goes, PolygonMesh& mesh) {
    Index end = 0, begin = 0;
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const Index next = mesh.first[f + 1];
        for (; begin < next; ++begin)
            if (goes[mesh.corners[begin]] == 0) mesh.corners[end++] = mesh.corners[begin];
        mesh.first[f + 1] = end;
    });
    mesh.corners.resize(end);
}

} // namespace

std::size_t drop_straight_vertices(double tolerance, PolygonMesh& mesh) {
    const VertexFacets at = facets_at_vertices(mesh);
    std::vector<Between> straight = straight_ones(mesh, at, tolerance);
    if (straight.empty()) return 0;
    keep_new_edges(mesh, straight);
    std::vector<std::uint8_t> goes = large_vector<std::uint8_t>(mesh.vertex_count());
    for (const Between& one : straight) goes[one.vertex] = 1;
    take_out(goes, mesh);
    return straight.size();
}

std::size_t merge_doublets(PolygonMesh& mesh, const std::function<bool(Index)>& expendable) {
    std::size_t merged = 0;
    while (const std::size_t count = merge_once(mesh, expendable, Folded::go))
        merged += count; // facets get fewer
    return merged;
}

std::size_t merge_doublets_at(PolygonMesh& mesh, const std::function<bool(Index)>& there) {
    std::size_t merged = 0;
    while (const std::size_t count = merge_once(mesh, there, Folded::stay)) merged += count;
    return merged;
}

} // namespace hsdm
