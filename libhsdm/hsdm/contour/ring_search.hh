#pragma once
// Short rings of edges that do not bound what lies round a vertex.

#include "hsdm/core/small_table.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// A mesh, its links, and how to go round its vertices.
class VertexFans {
public:
    /// Both must outlive it. O(corners).
    VertexFans(const PolygonMesh& mesh, const FacetLinks& links);

    Index facet_of(Index side) const { return links.facet[side]; }
    Index end(Index side) const { return mesh.corners[next_side(mesh, facet_of(side), side)]; }

    /// Calls f for the sides that start at a vertex: of one of its fans of facets, if it has several.
    template <class F>
    void for_each_side_out(Index v, F&& f) const {
        const Index first = side_out_[v];
        if (first == no_index) return;
        Index c = first;
        do { // one way round, as far as it goes
            f(c);
            c = links.twin[previous_side(mesh, facet_of(c), c)];
        } while (c != first && c != no_index);
        if (c == first) return;
        for (c = links.twin[first]; c != no_index; c = links.twin[c]) { // the other way from the first
            c = next_side(mesh, facet_of(c), c);
            f(c);
        }
    }
    /// The side that runs from one vertex to another, or no_index.
    Index side_between(Index from, Index to) const;

    /// The sides of a ring of vertices, on its left; none if one of them has no twin, or a vertex no facets
    /// of its fan on both sides of the ring.
    std::vector<Index> sides_of(std::span<const Index> ring) const;
    /// The corners of the i-th vertex of a ring on the left of it, and on the right, one after the other.
    std::vector<Index> corners_left_of(std::span<const Index> sides, std::size_t i) const {
        return corners_between(sides[i], sides[(i == 0 ? sides.size() : i) - 1]);
    }
    std::vector<Index> corners_right_of(std::span<const Index> sides, std::size_t i) const {
        return corners_between(links.twin[sides[(i == 0 ? sides.size() : i) - 1]], links.twin[sides[i]]);
    }
    /// The facets on both sides of a ring, each as often as it has a side of it.
    std::vector<Index> facets_beside(std::span<const Index> sides) const;

    const PolygonMesh& mesh;
    const FacetLinks& links;

private:
    std::vector<Index> corners_between(Index side, Index last) const;

    std::vector<Index> side_out_; // per vertex, a side that starts there
};

/// Looks for rings, one after the other. For one thread.
class RingSearch {
public:
    explicit RingSearch(const VertexFans& fans) : fans_(fans) {}

    /// The shortest ring of edges round a vertex that does not bound a disc of the facets within
    /// handles::reach edges; empty if there is none. Twice the reach and one edge is the longest.
    std::vector<Index> ring_at(Index root);

private:
    struct Node {
        Index vertex, parent; // place of the parent among the nodes
        int depth;
        double length; // of the way from the root
    };
    struct Edge {
        double length; // of the ring that it closes
        Index side, a, b;
    };

    void gather(Index root);
    const Edge* left_over();
    Index find(Index i);
    std::vector<Index> ring_of(const Edge& e) const;

    const VertexFans& fans_;
    SmallTable place_, facet_place_; // of vertices and facets among those gathered
    std::vector<Node> nodes_;
    std::vector<Index> facets_;
    std::vector<Edge> edges_;
    std::vector<Index> joined_, beside_;
};

} // namespace hsdm
