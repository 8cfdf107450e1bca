#include "hsdm/mesh/triangle_sides.hh"

#include "hsdm/mesh/edge_table.hh"

#include <atomic>

namespace hsdm {
namespace {

/// The sides of triangles, and behind them those of other facets.
EdgeTable edges_of(std::span<const Index> corners, const PolygonMesh& others, std::size_t vertex_count) {
    const auto count = static_cast<Index>(corners.size());
    return EdgeTable(vertex_count, [&](const auto& visit) {
        for_chunks(count, 3 * chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (auto s = static_cast<Index>(begin); s < end; ++s)
                visit(corners[s], corners[next_side(s)], s);
        });
        for (std::size_t f = 0; f < others.facet_count(); ++f) {
            const auto ring = others.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i)
                visit(ring[i], ring[(i + 1) % ring.size()], count + others.first[f] + static_cast<Index>(i));
        }
    });
}

} // namespace

TriangleSides link_triangles(std::span<const Index> corners, const PolygonMesh& others,
                             std::size_t vertex_count) {
    TriangleSides result{std::vector<Index>(corners.size(), no_index),
                         std::vector<std::uint8_t>(vertex_count, 0)};
    std::atomic<bool> crowded = false;
    const auto start = [&](Index s) {
        return s < corners.size() ? corners[s] : others.corners[s - corners.size()];
    };
    // Edges of other chunks may end at the same border.
    const auto mark = [&](Index v) { std::atomic_ref(result.border[v]).store(1, std::memory_order_relaxed); };
    edges_of(corners, others, vertex_count)
        .for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t) {
            if (edge.size() == 1) mark(lower), mark(edge[0].upper);
            const Index s = edge.front().side, t = edge.back().side;
            const bool same_way = edge.size() == 2 && start(s) == start(t);
            if (edge.size() > 2 || same_way) crowded.store(true, std::memory_order_relaxed);
            if (edge.size() != 2 || same_way || t >= corners.size()) return;
            result.twin[s] = t;
            result.twin[t] = s;
        });
    result.crowded = crowded;
    return result;
}

} // namespace hsdm
