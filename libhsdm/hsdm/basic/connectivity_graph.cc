#include "hsdm/basic/connectivity_graph.hh"

#include "hsdm/basic/voxel_centroid.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"

#include <atomic>
#include <bit>
#include <numeric>
#include <string>

namespace hsdm {
namespace {

constexpr Index grain = 4096;

/// Each vertex's chosen neighbours: those of vertex v are target[first[v]] .. target[first[v + 1]].
struct Choices {
    std::vector<Index> first, target;
    bool chose(Index v, Index u) const {
        const auto end = target.begin() + first[v + 1];
        return std::find(target.begin() + first[v], end, u) != end;
    }
};

void check(const NeighborChoiceOptions& options) {
    if (options.wanted < 1 || options.wanted > neighbor_count)
        throw OptionError("wanted " + std::to_string(options.wanted) + ": must lie in [1, 18]");
    if (options.max_face_neighbors < std::min(options.wanted, 6) || options.max_face_neighbors > 6)
        throw OptionError("max_face_neighbors " + std::to_string(options.max_face_neighbors)
                          + ": must lie in [wanted, 6]");
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
    const std::size_t n = level.size(), chunks = (n + grain - 1) / grain;
    Choices choices;
    choices.first.assign(n + 1, 0);
    std::vector<std::vector<Index>> targets(chunks);
    for_each_task(chunks, [&](std::size_t chunk) {
        targets[chunk].reserve(5 * grain);
        for (std::size_t v = chunk * grain; v < std::min(n, (chunk + 1) * grain); ++v)
            choices.first[v + 1] = choose(level, positions, static_cast<Index>(v), options, targets[chunk]);
    });
    std::partial_sum(choices.first.begin(), choices.first.end(), choices.first.begin());
    choices.target.resize(choices.first.back());
    for_each_task(chunks, [&](std::size_t chunk) {
        std::copy(targets[chunk].begin(), targets[chunk].end(),
                  choices.target.begin() + choices.first[chunk * grain]);
    });
    return choices;
}

/// Both directions of every edge, sorted by start and end. A one-sided choice is entered at its far end too;
/// the order in which threads do so is wiped out by the sort.
void make_half_edges(const Choices& choices, bool mutual, ConnectivityGraph& graph) {
    const std::size_t n = graph.vertex_count();
    std::vector<Index> degree(n, 0);
    auto for_each_edge = [&](auto&& enter) {
        for_each_index(n, grain, [&](Index v) {
            for (Index i = choices.first[v]; i < choices.first[v + 1]; ++i) {
                const Index u = choices.target[i];
                const bool both = choices.chose(u, v);
                if (both || !mutual) enter(v, u);
                if (!both && !mutual) enter(u, v);
            }
        });
    };
    for_each_edge(
        [&](Index from, Index) { std::atomic_ref(degree[from]).fetch_add(1, std::memory_order_relaxed); });
    graph.first_edge.assign(n + 1, 0);
    std::partial_sum(degree.begin(), degree.end(), graph.first_edge.begin() + 1);
    graph.end.resize(graph.first_edge.back());
    std::vector<Index> next(graph.first_edge.begin(), graph.first_edge.end() - 1);
    for_each_edge([&](Index from, Index to) {
        graph.end[std::atomic_ref(next[from]).fetch_add(1, std::memory_order_relaxed)] = to;
    });
    for_each_index(n, grain, [&](Index v) {
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
    for_each_index(graph.vertex_count(), grain, [&](Index v) {
        for (Index h = graph.first_edge[v]; h < graph.first_edge[v + 1]; ++h)
            graph.twin[h] = graph.find(graph.end[h], v);
    });
    return graph;
}

} // namespace hsdm
