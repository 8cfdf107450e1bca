#include "hsdm/pipeline/extended_graph.hh"

#include "hsdm/core/chunks.hh"

namespace hsdm {

ConnectivityGraph extended_graph(const PolygonMesh& facets, const std::vector<Index>& voxel) {
    std::vector<std::pair<Index, Index>> half_edges;
    half_edges.reserve(2 * facets.corners.size());
    for (std::size_t f = 0; f < facets.facet_count(); ++f) {
        const auto ring = facets.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            half_edges.emplace_back(a, b);
            half_edges.emplace_back(b, a);
        }
    }
    sort_unique(half_edges);

    ConnectivityGraph graph;
    graph.positions = facets.positions;
    graph.voxel = voxel;
    graph.first_edge.assign(facets.vertex_count() + 1, 0);
    graph.end.reserve(half_edges.size());
    for (const auto& [from, to] : half_edges) {
        ++graph.first_edge[from + 1];
        graph.end.push_back(to);
    }
    counts_to_first(graph.first_edge);
    graph.twin.resize(half_edges.size());
    for (std::size_t h = 0; h < half_edges.size(); ++h)
        graph.twin[h] = graph.find(half_edges[h].second, half_edges[h].first);
    return graph;
}

} // namespace hsdm
