#include "hsdm/simplify/unchanged.hh"

#include "hsdm/core/groups.hh"

#include <algorithm>

namespace hsdm {
namespace {

Index origin_of(const PolygonMesh& mesh, Index v) {
    return mesh.origin.empty() ? v : mesh.origin[v];
}

void find_vertices(const PolygonMesh& before, const PolygonMesh& now, Unchanged& same) {
    const std::size_t origins = before.origin.empty()
                                    ? before.vertex_count()
                                    : std::size_t{*std::ranges::max_element(before.origin)} + 1;
    std::vector<Index> vertex_of = large_vector<Index>(origins, no_index);
    for_each_in_order(before.vertex_count(), [&](std::size_t i) {
        const auto v = static_cast<Index>(i);
        vertex_of[origin_of(before, v)] = v;
    });
    for_each_in_order(now.vertex_count(), [&](std::size_t i) {
        const auto v = static_cast<Index>(i);
        const Index origin = origin_of(now, v);
        const Index was = origin < origins ? vertex_of[origin] : no_index;
        if (was == no_index || before.positions[was] != now.positions[v]) return;
        same.vertex[v] = was;
        same.vertex_now[was] = v;
    });
}

/// Turns a triangle to begin at its least vertex. How a larger polygon is cut depends on where it begins.
void normalise(std::vector<Index>& ring) {
    if (ring.size() == 3) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
}

/// Per facet, the first vertex of its normalised ring.
std::vector<Index> first_vertices(const PolygonMesh& mesh) {
    std::vector<Index> first = large_vector<Index>(mesh.facet_count());
    for_each_index(first.size(), chunks::light, [&](Index f) {
        const auto ring = mesh.facet(f);
        first[f] = ring.size() == 3 ? *std::min_element(ring.begin(), ring.end()) : ring[0];
    });
    return first;
}

void find_facets(const PolygonMesh& before, const PolygonMesh& now, Unchanged& same) {
    const Groups facets_from(first_vertices(before), before.vertex_count());
    for_chunks(now.facet_count(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Index> ring, other;
        for (std::size_t f = begin; f < end; ++f) {
            ring.clear();
            for (Index v : now.facet(f)) ring.push_back(same.vertex[v]);
            if (std::ranges::find(ring, no_index) != ring.end()) continue;
            normalise(ring);
            for (Index g : facets_from.of(ring[0])) {
                other.assign(before.facet(g).begin(), before.facet(g).end());
                normalise(other);
                if (ring != other) continue;
                same.facet[f] = g;
                break;
            }
        }
    });
    for_each_in_order(now.facet_count(), [&](std::size_t i) {
        const auto f = static_cast<Index>(i);
        if (same.facet[f] == no_index) return;
        Index& twice = same.facet_now[same.facet[f]];
        if (twice == no_index)
            twice = f;
        else
            same.facet[f] = no_index;
    });
}

} // namespace

Unchanged find_unchanged(const PolygonMesh& before, const PolygonMesh& now) {
    Unchanged same{large_vector<Index>(now.vertex_count(), no_index),
                   large_vector<Index>(now.facet_count(), no_index),
                   large_vector<Index>(before.vertex_count(), no_index),
                   large_vector<Index>(before.facet_count(), no_index)};
    find_vertices(before, now, same);
    find_facets(before, now, same);
    return same;
}

} // namespace hsdm
