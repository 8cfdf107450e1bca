#pragma once
// The sides (half-edges) of facets grouped by edge: the basis of every question about adjacency in meshes
// that may not be 2-manifolds. For 2-manifolds FacetLinks hold more.

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <atomic>
#include <span>

namespace hsdm {

/// A side of a facet, from one of its corners to the next, as part of an edge.
struct EdgeSide {
    Index upper; ///< the higher one of the edge's two vertices
    Index side;  ///< the side's number: that of the corner it starts at
    auto operator<=>(const EdgeSide&) const = default;
};

/// The sides of any facets, grouped by edge, in each by ascending number.
class EdgeTable {
public:
    /// `for_each_side(visit)` calls visit(from, to, side) for each side, from as many threads as it likes;
    /// it is called twice. O(sides log (sides of a vertex)), parallel.
    template <class ForEachSide>
    EdgeTable(std::size_t vertex_count, const ForEachSide& for_each_side);
    explicit EdgeTable(const PolygonMesh& mesh);

    /// Calls visit(lower, edge, chunk) for every edge, which joins vertex `lower` to edge[0].upper; `edge`
    /// holds its sides. In parallel, the edges of one chunk in order.
    template <class Visit>
    void for_edges(const Visit& visit) const;
    std::size_t chunks() const { return chunk_count(first_.size() - 1, vertices_per_chunk); }

private:
    static constexpr std::size_t vertices_per_chunk = chunks::slow; // chunks() relies on it

    std::vector<Index> first_; // per vertex, where the sides of the edges begin whose lower vertex it is
    std::vector<EdgeSide> sides_;
};

/// Per side, the next one of its facet. O(sides), parallel.
std::vector<Index> next_sides(const PolygonMesh& mesh);

template <class ForEachSide>
EdgeTable::EdgeTable(std::size_t vertex_count, const ForEachSide& for_each_side)
    : first_(large_vector<Index>(vertex_count + 1, 0)) {
    for_each_side([&](Index from, Index to, Index) {
        std::atomic_ref(first_[std::min(from, to) + 1]).fetch_add(1, std::memory_order_relaxed);
    });
    counts_to_first(first_);
    resize_unwritten(sides_, first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for_each_side([&](Index from, Index to, Index side) {
        sides_[std::atomic_ref(next[std::min(from, to)]).fetch_add(1, std::memory_order_relaxed)] = {
            std::max(from, to), side};
    });
    for_each_index(vertex_count, vertices_per_chunk,
                   [&](Index v) { std::sort(sides_.begin() + first_[v], sides_.begin() + first_[v + 1]); });
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
