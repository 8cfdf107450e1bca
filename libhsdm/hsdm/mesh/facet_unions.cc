#include "hsdm/mesh/facet_unions.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/facet_links.hh"

#include <algorithm>
#include <atomic>
#include <tuple>

namespace hsdm {
namespace {

/// The ring of a facet from the corner after v round to the one before it.
std::vector<Index> without(std::span<const Index> ring, Index v) {
    const auto at = std::find(ring.begin(), ring.end(), v);
    std::vector<Index> rest(at + 1, ring.end());
    rest.insert(rest.end(), ring.begin(), at);
    return rest;
}

/// The ring from the corner `from` round to the one before.
std::vector<Index> ring_from(std::span<const Index> ring, Index from) {
    std::vector<Index> turned(ring.begin(), ring.end());
    std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), from), turned.end());
    return turned;
}

/// Of sides as long the one of the greatest vertices, whichever way round the facet is.
Index longest_side(const PolygonMesh& mesh, Index f) {
    Index longest = mesh.first[f];
    std::tuple<double, Index, Index> most{-1, 0, 0};
    for (Index side = mesh.first[f]; side < mesh.first[f + 1]; ++side) {
        const Index from = mesh.corners[side], to = mesh.corners[next_side(mesh, f, side)];
        const double length = (mesh.positions[to] - mesh.positions[from]).sqrnorm();
        const std::tuple order(length, std::min(from, to), std::max(from, to));
        if (order > most) most = order, longest = side;
    }
    return longest;
}

} // namespace

VertexFacets facets_at_vertices(const PolygonMesh& mesh) {
    const std::size_t n = mesh.vertex_count();
    VertexFacets at{large_vector<std::array<Index, 2>>(n), large_vector<std::uint8_t>(n)};
    std::vector<Index> counts = large_vector<Index>(n);
    for_each_index(mesh.facet_count(), chunks::light, [&](Index f) {
        for (Index v : mesh.facet(f)) {
            const Index place = std::atomic_ref(counts[v]).fetch_add(1, std::memory_order_relaxed);
            if (place < 2) at.facets[v][place] = f;
        }
    });
    for_each_index(n, chunks::light, [&](Index v) {
        at.count[v] = static_cast<std::uint8_t>(std::min<Index>(counts[v], 3));
        // in ascending order, whichever thread came first
        if (counts[v] == 2) std::ranges::sort(at.facets[v]);
        if (counts[v] > 2) at.facets[v] = {};
    });
    return at;
}

UnitedFacets united(const PolygonMesh& mesh, const VertexFacets& at, Index between) {
    const auto [f, g] = at.facets[between];
    const std::vector<Index> ring = without(mesh.facet(f), between), other = without(mesh.facet(g), between);
    // The vertex is inner if g goes on where f comes from, and the other way round.
    if (ring.front() != other.back() || ring.back() != other.front()) return {};
    UnitedFacets whole{{}, {between}};
    // where the shared path ends: f keeps [begin, end), g as many less on either side
    std::size_t begin = 0, end = ring.size(), last = other.size();
    const auto is_inner = [&](Index v) { return at.count[v] == 2; };
    for (; end - begin > 2 && last > 2 && is_inner(ring[begin]) && ring[begin + 1] == other[last - 2];
         ++begin, --last)
        whole.between.push_back(ring[begin]);
    std::size_t first = 0;
    for (;
         end - begin > 2 && last - first > 2 && is_inner(ring[end - 1]) && ring[end - 2] == other[first + 1];
         --end, ++first)
        whole.between.push_back(ring[end - 1]);
    whole.ring.assign(ring.begin() + static_cast<std::ptrdiff_t>(begin),
                      ring.begin() + static_cast<std::ptrdiff_t>(end));
    whole.ring.insert(whole.ring.end(), other.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                      other.begin() + static_cast<std::ptrdiff_t>(last) - 1);
    std::vector<Index> sorted = whole.ring;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return {};
    return whole;
}

std::vector<Index> united_across(std::span<const Index> f, std::span<const Index> g, Index from, Index to) {
    std::vector<Index> whole = ring_from(f, to);
    const std::vector<Index> other = ring_from(g, from);
    whole.insert(whole.end(), other.begin() + 1, other.end() - 1);
    std::vector<Index> once = whole;
    sort_unique(once);
    return once.size() == whole.size() ? whole : std::vector<Index>();
}

void FacetUnions::unite(Index f, Index g, std::vector<Index> ring) {
    std::vector<std::vector<Index>> by;
    if (ring.size() >= 3) by.push_back(std::move(ring));
    replace(std::array{f, g}, std::move(by));
}

void FacetUnions::replace(std::span<const Index> facets, std::vector<std::vector<Index>> by) {
    for (const Index f : facets) fate_[f] = goes;
    fate_[facets.front()] = static_cast<Index>(by_.size());
    by_.push_back(std::move(by));
}

std::size_t FacetUnions::apply(PolygonMesh& mesh) const {
    if (by_.empty()) return 0;
    PolygonMesh kept;
    reserve_large(kept.corners, mesh.corners.size());
    reserve_large(kept.first, mesh.first.size());
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        if (fate_[f] == stays)
            kept.add_facet(mesh.facet(f));
        else if (fate_[f] != goes)
            for (const std::vector<Index>& facet : by_[fate_[f]]) kept.add_facet(facet);
    });
    mesh.corners = std::move(kept.corners);
    mesh.first = std::move(kept.first);
    return by_.size();
}

std::size_t unite_across_longest(std::span<const Index> facets, PolygonMesh& mesh) {
    if (facets.empty()) return 0;
    const FacetLinks links = link_facets(mesh);
    FacetUnions unions(mesh);
    for (const Index f : facets) {
        const Index side = longest_side(mesh, f), twin = links.twin[side];
        if (twin == no_index || !unions.is_free(f, links.facet[twin])) continue;
        const Index beyond = links.facet[twin];
        if (std::ranges::binary_search(facets, beyond)) continue; // together they would be as flat
        const std::vector<Index> whole = united_across(mesh.facet(f), mesh.facet(beyond), mesh.corners[side],
                                                       mesh.corners[next_side(mesh, f, side)]);
        if (!whole.empty()) unions.unite(f, beyond, ring_from(whole, std::ranges::min(whole)));
    }
    return unions.apply(mesh);
}

} // namespace hsdm
