#include "hsdm/mesh/triangle_sides.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace hsdm {
namespace {

constexpr std::size_t vertices_per_chunk = 1024;

/// Of sides by their lower vertex.
struct Side {
    Index high, side; // no_index: of another facet
    bool upwards;     // to the higher vertex
};

struct SidesByVertex {
    std::vector<std::size_t> first; // per vertex, and the end
    std::vector<Side> sides;        // by vertex
};

SidesByVertex gather_sides(std::span<const Index> corners, const PolygonMesh& others,
                           std::size_t vertex_count) {
    SidesByVertex by{std::vector<std::size_t>(vertex_count + 1, 0), {}};
    const auto for_each_side = [&](const auto& visit) {
        for (Index s = 0; s < corners.size(); ++s) visit(corners[s], corners[next_side(s)], s);
        for (std::size_t f = 0; f < others.facet_count(); ++f) {
            const auto ring = others.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i)
                visit(ring[i], ring[(i + 1) % ring.size()], no_index);
        }
    };
    for_each_side([&](Index a, Index b, Index) { ++by.first[std::min(a, b) + 1]; });
    std::partial_sum(by.first.begin(), by.first.end(), by.first.begin());
    by.sides.resize(by.first.back());
    std::vector<std::size_t> next(by.first.begin(), by.first.end() - 1);
    for_each_side([&](Index a, Index b, Index side) {
        by.sides[next[std::min(a, b)]++] = {std::max(a, b), side, a < b};
    });
    return by;
}

} // namespace

TriangleSides link_triangles(std::span<const Index> corners, const PolygonMesh& others,
                             std::size_t vertex_count) {
    SidesByVertex by = gather_sides(corners, others, vertex_count);
    TriangleSides result{std::vector<Index>(corners.size(), no_index),
                         std::vector<std::uint8_t>(vertex_count, 0)};
    std::atomic<bool> crowded = false;
    // Edges of other chunks may end at the same border.
    const auto mark = [&](Index v) { std::atomic_ref(result.border[v]).store(1, std::memory_order_relaxed); };
    for_chunks(vertex_count, vertices_per_chunk, [&](std::size_t low, std::size_t last, std::size_t) {
        for (; low < last; ++low) {
            const std::span sides =
                std::span(by.sides).subspan(by.first[low], by.first[low + 1] - by.first[low]);
            std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
                return a.high != b.high ? a.high < b.high : a.side < b.side;
            });
            for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
                while (end < sides.size() && sides[end].high == sides[begin].high) ++end;
                if (end - begin == 1) mark(static_cast<Index>(low)), mark(sides[begin].high);
                const Index s = sides[begin].side, t = sides[end - 1].side;
                if (end - begin > 2 || (end - begin == 2 && sides[begin].upwards == sides[end - 1].upwards))
                    crowded.store(true, std::memory_order_relaxed);
                if (end - begin != 2 || t == no_index || corners[s] == corners[t]) continue;
                result.twin[s] = t;
                result.twin[t] = s;
            }
        }
    });
    result.crowded = crowded;
    return result;
}

} // namespace hsdm
