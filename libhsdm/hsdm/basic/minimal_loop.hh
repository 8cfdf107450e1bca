#pragma once
// Section 3.2.2, Fig. 5 and 6: facets are minimal loops over the half-edges of the connectivity graph.

#include "hsdm/basic/connectivity_graph.hh"

namespace hsdm {

/// No loop has more edges than this, whatever is asked for.
inline constexpr int max_loop_edges = 8;

/// A closed walk over the graph, each half-edge starting where the one before ends. Empty: no loop.
struct Loop {
    std::array<Index, max_loop_edges> half_edges{};
    int size = 0;

    std::span<const Index> edges() const { return {half_edges.data(), static_cast<std::size_t>(size)}; }
};

/// The paper's walk to the letter: from `first`, ever on to the next edge that is not the twin of the current
/// one and whose end is nearest to the start of `first` (ties: the lower end vertex), until closed. Empty if
/// that takes more than max_edges or the walk runs into itself. O(max_edges * rank).
Loop walk_minimal_loop(const ConnectivityGraph& graph, Index first, int max_edges = max_loop_edges);

/// Every loop through `first` of at most max_edges that visits no vertex twice and has no chord (a chord
/// would make two shorter loops of it), in the paper's order: fewest edges first, then, step by step, by the
/// distance of the end to the loop's start. O(rank ^ (max_edges - 2)): for the few edges where short loops
/// are missing.
std::vector<Loop> minimal_loops_through(const ConnectivityGraph& graph, Index first, int max_edges);

/// Loops as flat arrays; loop i is half_edges[begin[i]] .. half_edges[begin[i + 1]].
struct LoopList {
    std::vector<Index> half_edges;
    std::vector<Index> begin{0};

    std::size_t size() const { return begin.size() - 1; }
    std::span<const Index> operator[](std::size_t i) const {
        return {half_edges.data() + begin[i], half_edges.data() + begin[i + 1]};
    }
};

/// Every triangle and every quad without chord of the graph, once, in one of its two directions, starting at
/// its lowest vertex, in ascending order. O(n) as ranks are bounded, parallel, independent of the threads.
LoopList find_short_loops(const ConnectivityGraph& graph);

} // namespace hsdm
