#pragma once
// Triangles whose edges collapse and are flipped: the one place where half-edges are rewired.

#include "hsdm/mesh/triangle_sides.hh"

namespace hsdm {

/// The half-edges of triangles, as flat arrays. Side (half-edge) s of triangle s / 3 runs from start(s) to
/// end(s). Whether an edit keeps a 2-manifold, and whether it is wanted, is the caller's concern.
class EditableTriangles {
public:
    /// `corners`: three vertices per triangle. `others`: facets over the same vertices that stay; sides of
    /// edges shared with them have no twin. O(corners), parallel in parts.
    EditableTriangles(std::vector<Index> corners, const PolygonMesh& others, std::size_t vertex_count);

    std::size_t vertex_count() const { return facets_.size(); }
    std::size_t side_count() const { return corners_.size(); }
    bool is_gone(Index side) const { return corners_[side] == no_index; }
    Index start(Index side) const { return corners_[side]; }
    Index end(Index side) const { return corners_[next_side(side)]; }
    /// The vertex of the side's triangle that is not on the side.
    Index opposite(Index side) const { return corners_[previous_side(side)]; }
    Index twin(Index side) const { return twin_[side]; }
    /// The corners of a triangle, which begin at side 3 * triangle.
    std::span<const Index, 3> triangle(Index t) const {
        return std::span<const Index, 3>(&corners_[3 * t], 3);
    }

    bool is_border(Index v) const { return border_[v]; }
    /// Number of facets at a vertex, the others among them.
    Index facet_count(Index v) const { return facets_[v]; }
    /// How many facets a vertex must keep: three, or one at a border.
    Index least_facets(Index v) const { return border_[v] ? 1 : 3; }
    /// May a vertex lose a facet?
    bool spares(Index v) const { return facets_[v] > least_facets(v); }
    /// Does an edge have more than two sides, or two that run the same way?
    bool is_crowded() const { return crowded_; }

    /// Lists the neighbours of a side's start in order, the side's end first; false if its triangles do not
    /// form one closed fan of all of its facets.
    bool ring_of(Index side, std::vector<Index>& ring) const;

    /// Flips the edge of a side with a twin. Let the side run a b, in triangle a b c, its twin in b a d: the
    /// side's triangle becomes d b c, the twin's c a d. The side is d b then, its former twin c a, the new
    /// edge that of previous_side(side), and b c and a d are where they were.
    void flip_edge(Index side);
    /// Counts the two triangles at a side as one facet from now on.
    void count_as_one(Index side) { --facets_[start(side)], --facets_[end(side)]; }
    /// Removes the two triangles at a side, of which neither end is at a border, and puts its end in place of
    /// its start.
    void collapse_edge(Index side);

private:
    void pair_up(Index s, Index t) {
        twin_[s] = t;
        if (t != no_index) twin_[t] = s;
    }

    std::vector<Index> corners_, twin_; // per side; corners are no_index where the triangle is gone
    std::vector<std::uint8_t> border_;  // per vertex
    std::vector<Index> facets_;         // per vertex
    bool crowded_;
};

} // namespace hsdm
