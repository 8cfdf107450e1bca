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

/// Where rings are compared from: triangles from their least vertex on. How a larger polygon is cut depends
/// on where it begins.
template <class At>
std::size_t beginning(std::size_t size, const At& at) {
    if (size != 3) return 0;
    return at(0) < at(1) ? (at(2) < at(0) ? 2 : 0) : (at(2) < at(1) ? 2 : 1);
}

/// Per facet, the first vertex of its ring as it is compared.
std::vector<Index> first_vertices(const PolygonMesh& mesh) {
    std::vector<Index> first = unwritten_vector<Index>(mesh.facet_count());
    for_each_index(first.size(), chunks::light, [&](Index f) {
        const auto ring = mesh.facet(f);
        first[f] = ring[beginning(ring.size(), [&](std::size_t i) { return ring[i]; })];
    });
    return first;
}

void find_facets(const PolygonMesh& before, const PolygonMesh& now, Unchanged& same) {
    const Groups facets_from(first_vertices(before), before.vertex_count());
    for_each_index(now.facet_count(), chunks::usual, [&](Index f) {
        const auto ring = now.facet(f);
        const std::size_t size = ring.size();
        for (const Index v : ring)
            if (same.vertex[v] == no_index) return;
        const auto was = [&](std::size_t i) { return same.vertex[ring[i]]; };
        const std::size_t begin = beginning(size, was);
        for (const Index g : facets_from.of(was(begin))) {
            const auto other = before.facet(g);
            if (other.size() != size) continue;
            const std::size_t there = beginning(size, [&](std::size_t i) { return other[i]; });
            std::size_t alike = 1; // corners; the first ones are the same
            while (alike < size && was((begin + alike) % size) == other[(there + alike) % size]) ++alike;
            if (alike < size) continue;
            same.facet[f] = g;
            break;
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
