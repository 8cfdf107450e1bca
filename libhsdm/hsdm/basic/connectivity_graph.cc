#include "hsdm/basic/connectivity_graph.hh"

#include "hsdm/basic/voxel_centroid.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"

#include <atomic>
#include <bit>
#include <numeric>
#include <string>

namespace hsdm {
namespace {

/// Each vertex's chosen neighbours: those of vertex v are target[first[v]] .. target[first[v + 1]].
struct Choices {
    std::vector<Index> first, target;
    bool chose(Index v, Index u) const {
        const auto end = target.begin() + first[v + 1];
        return std::find(target.begin() + first[v], end, u) != end;
    }
};

void check(const NeighborChoiceOptions& options) {
    check_option(options.wanted >= 1 && options.wanted <= neighbor_count, "wanted", options.wanted,
                 "lie in [1, 18]");
    check_option(options.max_face_neighbors >= std::min(options.wanted, 6) && options.max_face_neighbors <= 6,
                 "max_face_neighbors", options.max_face_neighbors, "lie in [wanted, 6]");
}

/// The neighbours of one voxel, appended to `out`. Edge neighbours are looked up only if they can matter.
Index choose(const OctreeLevel& level, const std::vector<Vec3>& positions, Index voxel,
             const NeighborChoiceOptions& options, std::vector<Index>& out) {
    std::array<Index, neighbor_count> found;
    NeighborDistances distance{};
    NeighborMask present = 0;
    const VoxelCoord c = level.coord(voxel);
    auto look = [&](unsigned begin, unsigned end) {
        for (unsigned i = begin; i < end; ++i) {
            const VoxelCoord& o = neighbor_offsets[i];
            found[i] = level.find(VoxelCoord{c[0] + o[0], c[1] + o[1], c[2] + o[2]});
            if (found[i] == no_index) continue;
            present |= NeighborMask{1} << i;
            distance[i] = (positions[found[i]] - positions[voxel]).sqrnorm();
        }
    };
    look(0, 6);
    if (std::popcount(present) < options.wanted) look(6, neighbor_count);
    const NeighborMask chosen = choose_neighbors(present, distance, options);
    for (NeighborMask rest = chosen; rest != 0; rest &= rest - 1)
        out.push_back(found[static_cast<unsigned>(std::countr_zero(rest))]);
    return static_cast<Index>(std::popcount(chosen));
}

/// Chunks are fixed, so the lists come out alike for any number of threads.
Choices choose_all(const OctreeLevel& level, const std::vector<Vec3>& positions,
                   const NeighborChoiceOptions& options) {
    Choices choices;
    choices.first.assign(level.size() + 1, 0);
    const auto choose_some = [&](std::size_t begin, std::size_t end, std::vector<Index>& targets) {
        targets.reserve(5 * chunks::quick);
        for (auto v = static_cast<Index>(begin); v < end; ++v)
            choices.first[v + 1] = choose(level, positions, v, options, targets);
    };
    choices.target = collected<Index>(level.size(), chunks::quick, choose_some);
    counts_to_first(choices.first);
    return choices;
}

/// Both directions of every edge, sorted by start and end. A one-sided choice is entered at its far end too;
/// the order in which threads do so is wiped out by the sort.
void make_half_edges(const Choices& choices, bool mutual, ConnectivityGraph& graph) {
    const std::size_t n = graph.vertex_count();
    auto for_each_edge = [&](auto&& enter) {
        for_each_index(n, chunks::quick, [&](Index v) {
            for (Index i = choices.first[v]; i < choices.first[v + 1]; ++i) {
                const Index u = choices.target[i];
                const bool both = choices.chose(u, v);
                if (both || !mutual) enter(v, u);
                if (!both && !mutual) enter(u, v);
            }
        });
    };
    graph.first_edge.assign(n + 1, 0);
    for_each_edge([&](Index from, Index) {
        std::atomic_ref(graph.first_edge[from + 1]).fetch_add(1, std::memory_order_relaxed);
    });
    counts_to_first(graph.first_edge);
    graph.end.resize(graph.first_edge.back());
    std::vector<Index> next(graph.first_edge.begin(), graph.first_edge.end() - 1);
    for_each_edge([&](Index from, Index to) {
        graph.end[std::atomic_ref(next[from]).fetch_add(1, std::memory_order_relaxed)] = to;
    });
    for_each_index(n, chunks::quick, [&](Index v) {
        std::sort(graph.end.begin() + graph.first_edge[v], graph.end.begin() + graph.first_edge[v + 1]);
    });
}

} // namespace

ConnectivityGraph extract_graph(const Octree& octree, const OctreeLevel& level, const GraphOptions& options) {
    check(options.neighbors);
    ConnectivityGraph graph;
    graph.positions = voxel_centroids(octree, level);
    graph.voxel.resize(level.size());
    std::iota(graph.voxel.begin(), graph.voxel.end(), Index{0});
    make_half_edges(choose_all(level, graph.positions, options.neighbors), options.mutual, graph);
    graph.twin.resize(graph.half_edge_count());
    for_each_index(graph.vertex_count(), chunks::quick, [&](Index v) {
        for (Index h = graph.first_edge[v]; h < graph.first_edge[v + 1]; ++h)
            graph.twin[h] = graph.find(graph.end[h], v);
    });
    return graph;
}

} // namespace hsdm
