#pragma once
// The sides of facets by the edges that they lie on: where every question about the adjacency of facets
// begins that may be no 2-manifold yet. Of those that are one, FacetLinks know more.

#include "hsdm/core/chunks.hh"
#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <atomic>
#include <span>

namespace hsdm {

/// A side of a facet, which runs from its corner to the facet's next one, on an edge.
struct EdgeSide {
    Index upper; ///< the higher one of the edge's two vertices
    Index side;  ///< number of the corner that it starts at
    auto operator<=>(const EdgeSide&) const = default;
};

/// The sides of any facets, those of an edge together and by ascending number.
class EdgeTable {
public:
    /// `for_each_side(visit)` calls visit(from, to, side) for each side, from as many threads as it likes;
    /// it is called twice. O(sides log (sides of a vertex)), parallel.
    template <class ForEachSide>
    EdgeTable(std::size_t vertex_count, const ForEachSide& for_each_side);
    explicit EdgeTable(const PolygonMesh& mesh);

    /// Calls visit(lower, edge, chunk) for every edge, from its lower vertex to edge[0].upper, with the sides
    /// that lie on it; in parallel, those of one chunk in order.
    template <class Visit>
    void for_edges(const Visit& visit) const;
    std::size_t chunks() const { return chunk_count(first_.size() - 1, vertices_per_chunk); }

private:
    static constexpr std::size_t vertices_per_chunk = 1024, facets_per_chunk = 4096;

    std::vector<Index> first_; // per vertex, where the sides of edges that it is the lower one of begin
    std::vector<EdgeSide> sides_;
};

/// Per side, the next one of its facet. O(sides), parallel.
std::vector<Index> next_sides(const PolygonMesh& mesh);

template <class ForEachSide>
EdgeTable::EdgeTable(std::size_t vertex_count, const ForEachSide& for_each_side)
    : first_(vertex_count + 1, 0) {
    for_each_side([&](Index from, Index to, Index) {
        std::atomic_ref(first_[std::min(from, to) + 1]).fetch_add(1, std::memory_order_relaxed);
    });
    counts_to_first(first_);
    sides_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for_each_side([&](Index from, Index to, Index side) {
        sides_[std::atomic_ref(next[std::min(from, to)]).fetch_add(1, std::memory_order_relaxed)] = {
            std::max(from, to), side};
    });
    for_chunks(vertex_count, vertices_per_chunk, [&](std::size_t v, std::size_t end, std::size_t) {
        for (; v < end; ++v) std::sort(sides_.begin() + first_[v], sides_.begin() + first_[v + 1]);
    });
}

template <class Visit>
void EdgeTable::for_edges(const Visit& visit) const {
    for_chunks(first_.size() - 1, vertices_per_chunk, [&](std::size_t v, std::size_t last, std::size_t c) {
        for (; v < last; ++v)
            for (Index begin = first_[v], end = begin; begin < first_[v + 1]; begin = end) {
                while (end < first_[v + 1] && sides_[end].upper == sides_[begin].upper) ++end;
                visit(static_cast<Index>(v), std::span(sides_).subspan(begin, end - begin), c);
            }
    });
}

} // namespace hsdm
