#include "hsdm/simplify/nonmanifold_vertices.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <atomic>
#include <limits>

namespace hsdm {
namespace {

constexpr std::size_t vertices_per_chunk = 1024, facets_per_chunk = 2048;
constexpr double flat = 1e-6; // twice a facet's area over its squared length, or a side over its length

/// A side of a facet: corner `corner` starts it, `next` ends it.
struct Side {
    Index low, high, corner, next;
    bool forward; // from low to high
};

template <class F>
void for_each_side(const PolygonMesh& mesh, const F& visit) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const Index begin = mesh.first[f], end = mesh.first[f + 1];
        for (Index c = begin; c < end; ++c) {
            const Index next = c + 1 == end ? begin : c + 1;
            const Index a = mesh.corners[c], b = mesh.corners[next];
            visit(Side{std::min(a, b), std::max(a, b), c, next, a < b});
        }
    }
}

/// Of every edge, those one after the other, by ascending corners; those of the edges whose lower vertex is v
/// from first[v] to first[v + 1].
struct SortedSides {
    std::vector<Side> sides;
    std::vector<Index> first;
};

SortedSides sorted_sides(const PolygonMesh& mesh) {
    std::vector<Side> sides(mesh.corners.size());
    // Two to the right, so that filling the sides in moves them to their places.
    std::vector<Index> first(mesh.vertex_count() + 2, 0);
    for_each_side(mesh, [&](const Side& side) { ++first[side.low + 2]; });
    counts_to_first(first);
    for_each_side(mesh, [&](const Side& side) { sides[first[side.low + 1]++] = side; });
    for_chunks(mesh.vertex_count(), vertices_per_chunk, [&](std::size_t v, std::size_t end, std::size_t) {
        for (; v < end; ++v)
            std::sort(sides.begin() + first[v], sides.begin() + first[v + 1],
                      [](const Side& a, const Side& b) {
                          return a.high != b.high ? a.high < b.high : a.corner < b.corner;
                      });
    });
    return {std::move(sides), std::move(first)};
}

std::vector<Index> flat_facets(const PolygonMesh& mesh) {
    std::vector<std::vector<Index>> parts(chunk_count(mesh.facet_count(), facets_per_chunk));
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t f, std::size_t end, std::size_t c) {
        for (; f < end; ++f) {
            const auto ring = mesh.facet(f);
            double longest = 0, shortest = std::numeric_limits<double>::infinity();
            Index before = ring.back();
            for (const Index v : ring) {
                longest = std::max(longest, (mesh.positions[v] - mesh.positions[ring[0]]).sqrnorm());
                shortest = std::min(shortest, (mesh.positions[v] - mesh.positions[before]).sqrnorm());
                before = v;
            }
            if (area_vector(mesh, ring).norm() <= flat * longest || shortest <= flat * flat * longest)
                parts[c].push_back(static_cast<Index>(f));
        }
    });
    return joined(parts);
}

} // namespace

std::vector<Index> nonmanifold_vertices(const PolygonMesh& mesh) {
    const SortedSides sorted = sorted_sides(mesh);
    const auto& sides = sorted.sides;
    const auto& first = sorted.first;
    std::vector<std::uint8_t> troubled(mesh.vertex_count(), 0), border(mesh.vertex_count(), 0);
    DisjointSets fans(mesh.corners.size());
    // Edges of other chunks may end at the same vertex.
    const auto mark = [](std::vector<std::uint8_t>& marks, const Side& side) {
        for (Index v : {side.low, side.high}) std::atomic_ref(marks[v]).store(1, std::memory_order_relaxed);
    };
    for_chunks(mesh.vertex_count(), vertices_per_chunk, [&](std::size_t v, std::size_t last, std::size_t) {
        for (std::size_t begin = first[v], end = begin; begin < first[last]; begin = end) {
            const Side& a = sides[begin];
            while (end < first[last] && sides[end].low == a.low && sides[end].high == a.high) ++end;
            if (end - begin == 1) {
                mark(border, a);
            } else if (const Side& b = sides[begin + 1]; end - begin == 2 && a.forward != b.forward) {
                fans.join(a.corner, b.next);
                fans.join(a.next, b.corner);
            } else {
                mark(troubled, a);
            }
        }
    });
    std::vector<Index> root(mesh.vertex_count(), no_index), facets(mesh.vertex_count(), 0);
    for (Index c = 0; c < mesh.corners.size(); ++c) {
        const Index v = mesh.corners[c];
        const Index r = fans.find(c);
        if (root[v] != no_index && root[v] != r) troubled[v] = 1;
        root[v] = r;
        ++facets[v];
    }
    for (Index f : flat_facets(mesh))
        for (Index v : mesh.facet(f)) troubled[v] = 1;
    std::vector<Index> result;
    for (Index v = 0; v < troubled.size(); ++v)
        if (troubled[v] || (facets[v] > 0 && facets[v] < 3 && !border[v])) result.push_back(v);
    return result;
}

} // namespace hsdm
