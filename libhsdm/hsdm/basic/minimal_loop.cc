#include "hsdm/basic/minimal_loop.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cassert>

namespace hsdm {
namespace {

std::span<const Index> ends(const ConnectivityGraph& graph, Index v) {
    return {graph.end.data() + graph.first_edge[v], graph.end.data() + graph.first_edge[v + 1]};
}

/// Depth-first search for loops; the depth is bounded by max_loop_edges.
class LoopSearch {
public:
    LoopSearch(const ConnectivityGraph& graph, Index first, int max_edges)
        : graph_(graph), start_(graph.start(first)), max_edges_(std::min(max_edges, max_loop_edges)) {
        loop_.half_edges[0] = first;
        loop_.size = 1;
        extend();
        std::stable_sort(found_.begin(), found_.end(),
                         [&](const Loop& a, const Loop& b) { return before(a, b); });
    }
    std::vector<Loop> take() { return std::move(found_); }

private:
    Index vertex(int i) const {
        return i == 0 ? start_ : graph_.end[loop_.half_edges[static_cast<unsigned>(i - 1)]];
    }

    /// Whether a vertex is on the path, or joined to one of its inner vertices but the last: a chord.
    bool blocked(Index v) const {
        for (int i = 0; i <= loop_.size; ++i)
            if (vertex(i) == v) return true;
        for (int i = 1; i < loop_.size; ++i)
            if (graph_.find(v, vertex(i)) != no_index) return true;
        return false;
    }

    void extend() {
        const Index at = vertex(loop_.size);
        for (Index h = graph_.first_edge[at]; h < graph_.first_edge[at + 1]; ++h) {
            const Index v = graph_.end[h];
            if (blocked(v)) continue;
            loop_.half_edges[static_cast<unsigned>(loop_.size++)] = h;
            const Index closing = graph_.find(v, start_);
            if (closing != no_index) {
                loop_.half_edges[static_cast<unsigned>(loop_.size++)] = closing;
                found_.push_back(loop_);
                --loop_.size;
            } else if (loop_.size + 2 <= max_edges_) {
                extend();
            }
            --loop_.size;
        }
    }

    bool before(const Loop& a, const Loop& b) const {
        if (a.size != b.size) return a.size < b.size;
        const Vec3& start = graph_.positions[start_];
        for (unsigned i = 1; i + 1 < static_cast<unsigned>(a.size); ++i) {
            const double da = (graph_.positions[graph_.end[a.half_edges[i]]] - start).sqrnorm();
            const double db = (graph_.positions[graph_.end[b.half_edges[i]]] - start).sqrnorm();
            if (da != db) return da < db;
        }
        return false;
    }

    const ConnectivityGraph& graph_;
    Index start_;
    int max_edges_;
    Loop loop_;
    std::vector<Loop> found_;
};

/// Triangles and quads whose lowest vertex is s; the second vertex is below the last, so each comes once.
void loops_from(const ConnectivityGraph& graph, Index s, std::vector<Index>& half_edges,
                std::vector<Index>& sizes) {
    for (Index sa = graph.first_edge[s]; sa < graph.first_edge[s + 1]; ++sa) {
        const Index a = graph.end[sa];
        if (a < s) continue;
        for (Index ab = graph.first_edge[a]; ab < graph.first_edge[a + 1]; ++ab) {
            const Index b = graph.end[ab];
            if (b <= s) continue;
            const Index bs = graph.find(b, s);
            if (bs != no_index) {
                if (b < a) continue;
                half_edges.insert(half_edges.end(), {sa, ab, bs});
                sizes.push_back(3);
                continue; // a quad over b would have the chord b-s
            }
            for (Index c : ends(graph, s)) {
                if (c <= a) continue;
                const Index bc = graph.find(b, c);
                if (bc == no_index || graph.find(c, a) != no_index) continue;
                half_edges.insert(half_edges.end(), {sa, ab, bc, graph.find(c, s)});
                sizes.push_back(4);
            }
        }
    }
}

} // namespace

Loop walk_minimal_loop(const ConnectivityGraph& graph, Index first, int max_edges) {
    const Index start = graph.start(first);
    Loop loop;
    loop.half_edges[0] = first;
    loop.size = 1;
    for (Index current = first; graph.end[current] != start;) {
        if (loop.size == std::min(max_edges, max_loop_edges)) return {};
        const Index at = graph.end[current];
        Index best = no_index;
        double best_distance = 0;
        for (Index h = graph.first_edge[at]; h < graph.first_edge[at + 1]; ++h) {
            if (h == graph.twin[current]) continue;
            const double d = (graph.positions[graph.end[h]] - graph.positions[start]).sqrnorm();
            if (best != no_index && d >= best_distance) continue;
            best = h;
            best_distance = d;
        }
        if (best == no_index) return {};
        for (Index h : loop.edges())
            if (graph.end[h] == graph.end[best]) return {};
        loop.half_edges[static_cast<unsigned>(loop.size++)] = current = best;
    }
    return loop;
}

std::vector<Loop> minimal_loops_through(const ConnectivityGraph& graph, Index first, int max_edges) {
    return LoopSearch(graph, first, max_edges).take();
}

LoopList find_short_loops(const ConnectivityGraph& graph) {
    std::vector<std::vector<Index>> half_edges(chunk_count(graph.vertex_count(), chunks::usual)),
        sizes(half_edges.size());
    for_chunks(graph.vertex_count(), chunks::usual,
               [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                   half_edges[chunk].reserve(5 * chunks::usual);
                   for (auto v = static_cast<Index>(begin); v < end; ++v)
                       loops_from(graph, v, half_edges[chunk], sizes[chunk]);
               });
    sizes.insert(sizes.begin(), std::vector<Index>{0});
    LoopList list{joined(half_edges), joined(sizes)};
    counts_to_first(list.begin);
    return list;
}

} // namespace hsdm
