#include "hsdm/facets/doublets.hh"

#include "hsdm/facets/area_vector.hh"

#include <algorithm>
#include <array>

namespace hsdm {
namespace {

constexpr double folded_cosine = -0.3;

/// The facets at each vertex with one or two of them, and how many there are.
struct VertexFacets {
    std::vector<std::array<Index, 2>> facets;
    std::vector<std::uint8_t> count; // 3: more than two
};

VertexFacets facets_at_vertices(const PolygonMesh& mesh) {
    VertexFacets at{std::vector<std::array<Index, 2>>(mesh.vertex_count()),
                    std::vector<std::uint8_t>(mesh.vertex_count(), 0)};
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index v : mesh.facet(f)) {
            if (at.count[v] < 2) at.facets[v][at.count[v]] = static_cast<Index>(f);
            at.count[v] = static_cast<std::uint8_t>(std::min(at.count[v] + 1, 3));
        }
    return at;
}

/// The ring of a facet from the corner after v round to the one before it.
std::vector<Index> without(std::span<const Index> ring, Index v) {
    const auto at = std::find(ring.begin(), ring.end(), v);
    std::vector<Index> rest(at + 1, ring.end());
    rest.insert(rest.end(), ring.begin(), at);
    return rest;
}

/// Both rings round a vertex between them as one, or nothing.
std::vector<Index> merged(std::span<const Index> f, std::span<const Index> g, Index v) {
    std::vector<Index> ring = without(f, v);
    const std::vector<Index> other = without(g, v);
    // An inner vertex: where f comes from, g goes to, and the other way round.
    if (ring.front() != other.back() || ring.back() != other.front()) return {};
    ring.insert(ring.end(), other.begin() + 1, other.end() - 1);
    std::vector<Index> sorted = ring;
    std::sort(sorted.begin(), sorted.end());
    const bool simple = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    return simple && ring.size() >= 3 ? ring : std::vector<Index>();
}

} // namespace

std::size_t merge_doublets(PolygonMesh& mesh, const std::function<bool(Index)>& expendable) {
    const VertexFacets at = facets_at_vertices(mesh);
    std::vector<std::vector<Index>> replaced; // instead of facets, at the place of the first of the two
    std::vector<Index> replacement(mesh.facet_count(), no_index);
    constexpr Index gone = no_index - 1;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto [f, g] = at.facets[v];
        if (at.count[v] != 2 || f == g || replacement[f] != no_index || replacement[g] != no_index) continue;
        const Vec3 one = unit(area_vector(mesh, mesh.facet(f))),
                   other = unit(area_vector(mesh, mesh.facet(g)));
        if (!expendable(v) && (one | other) > folded_cosine) continue;
        std::vector<Index> ring = merged(mesh.facet(f), mesh.facet(g), v);
        // Beside another vertex of only two facets the union might be the reverse of a third facet.
        if (ring.empty()
            || std::count_if(ring.begin(), ring.end(), [&](Index u) { return at.count[u] == 2; }) > 0)
            continue;
        replacement[f] = static_cast<Index>(replaced.size());
        replacement[g] = gone;
        replaced.push_back(std::move(ring));
    }
    if (replaced.empty()) return 0;
    PolygonMesh kept;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (replacement[f] == no_index)
            kept.add_facet(mesh.facet(f));
        else if (replacement[f] != gone)
            kept.add_facet(replaced[replacement[f]]);
    }
    mesh.corners = std::move(kept.corners);
    mesh.first = std::move(kept.first);
    return replaced.size();
}

} // namespace hsdm
