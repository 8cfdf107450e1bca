#include "hsdm/adaptive/triangle_sides.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

namespace hsdm {
namespace {

struct Side {
    Index low, high, side; // no_index: of another facet
    bool operator<(const Side& o) const {
        return std::tie(low, high, side) < std::tie(o.low, o.high, o.side);
    }
};

std::vector<Side> sorted_sides(std::span<const Index> corners, const PolygonMesh& others) {
    std::vector<Side> sides;
    sides.reserve(corners.size() + others.corners.size());
    const auto enter = [&](Index a, Index b, Index side) {
        sides.push_back({std::min(a, b), std::max(a, b), side});
    };
    for (Index s = 0; s < corners.size(); ++s) enter(corners[s], corners[next_side(s)], s);
    for (std::size_t f = 0; f < others.facet_count(); ++f) {
        const auto ring = others.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) enter(ring[i], ring[(i + 1) % ring.size()], no_index);
    }
    tbb::parallel_sort(sides.begin(), sides.end());
    return sides;
}

} // namespace

TriangleSides link_triangles(std::span<const Index> corners, const PolygonMesh& others,
                             std::size_t vertex_count) {
    const std::vector<Side> sides = sorted_sides(corners, others);
    TriangleSides result{std::vector<Index>(corners.size(), no_index),
                         std::vector<std::uint8_t>(vertex_count, 0)};
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        const Side& first = sides[begin];
        while (end < sides.size() && sides[end].low == first.low && sides[end].high == first.high) ++end;
        if (end - begin == 1) result.border[first.low] = result.border[first.high] = 1;
        const Index s = first.side, t = sides[end - 1].side;
        if (end - begin != 2 || t == no_index || corners[s] == corners[t]) continue;
        result.twin[s] = t;
        result.twin[t] = s;
    }
    return result;
}

} // namespace hsdm
