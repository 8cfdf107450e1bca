#include "hsdm/simplify/nonmanifold_vertices.hh"

#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/edge_table.hh"

#include <atomic>
#include <limits>

namespace hsdm {
namespace {

// largest ratio that counts as 0: of twice a facet's area to its squared length, of a side to its length
constexpr double flat = 1e-6;

std::vector<Index> flat_facets(const PolygonMesh& mesh) {
    return indices_where(mesh.facet_count(), chunks::usual, [&](Index f) {
        const auto ring = mesh.facet(f);
        double longest = 0, shortest = std::numeric_limits<double>::infinity();
        Index before = ring.back();
        for (const Index v : ring) {
            longest = std::max(longest, (mesh.positions[v] - mesh.positions[ring[0]]).sqrnorm());
            shortest = std::min(shortest, (mesh.positions[v] - mesh.positions[before]).sqrnorm());
            before = v;
        }
        return area_vector(mesh, ring).norm() <= flat * longest || shortest <= flat * flat * longest;
    });
}

} // namespace

std::vector<Index> nonmanifold_vertices(const PolygonMesh& mesh, std::span<const std::uint8_t> doublets) {
    std::vector<std::uint8_t> troubled = large_vector<std::uint8_t>(mesh.vertex_count()), border = troubled;
    DisjointSets fans(mesh.corners.size());
    // Edges of other chunks may end at the same vertex.
    const auto mark = [](std::vector<std::uint8_t>& marks, Index v, Index w) {
        for (Index end : {v, w}) std::atomic_ref(marks[end]).store(1, std::memory_order_relaxed);
    };
    const std::vector<Index> next = next_sides(mesh);
    EdgeTable(mesh).for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t) {
        const Index a = edge.front().side, b = edge.back().side;
        if (edge.size() == 1) {
            mark(border, lower, edge[0].upper);
        } else if (edge.size() == 2 && mesh.corners[a] != mesh.corners[b]) {
            fans.join(a, next[b]);
            fans.join(next[a], b);
        } else {
            mark(troubled, lower, edge[0].upper);
        }
    });
    std::vector<Index> root = large_vector<Index>(mesh.vertex_count(), no_index),
                       facets = large_vector<Index>(mesh.vertex_count());
    for_each_in_order(mesh.corners.size(), [&](std::size_t c) {
        const Index v = mesh.corners[c];
        const Index r = fans.find(static_cast<Index>(c));
        if (root[v] != no_index && root[v] != r) troubled[v] = 1;
        root[v] = r;
        ++facets[v];
    });
    for (Index f : flat_facets(mesh))
        for (Index v : mesh.facet(f)) troubled[v] = 1;
    return indices_where(troubled.size(), chunks::light, [&](Index v) {
        const Index least = !doublets.empty() && doublets[v] != 0 ? 2 : 3;
        return troubled[v] || (facets[v] > 0 && facets[v] < least && !border[v]);
    });
}

} // namespace hsdm
