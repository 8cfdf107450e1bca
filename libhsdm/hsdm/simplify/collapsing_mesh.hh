#pragma once
// The triangles of a 2-manifold while edges collapse.

#include "hsdm/mesh/triangle_sides.hh"

#include <span>

namespace hsdm {

/// What is left of a mesh. Vertices for which others stand are isolated.
struct CollapsedMesh {
    PolygonMesh mesh;
    std::vector<Index> stands_for;     ///< per vertex the one that stands for it now: itself or another
    std::vector<std::uint8_t> flipped; ///< per vertex, was an edge of its triangles laid the other way?
};

/// A mesh, cut into triangles, of which inner vertices merge into neighbours. Side s runs from start(s) to
/// end(s). Facets whose diagonals are edges of others too stay whole: their vertices are locked. To begin
/// anew, copy it before.
class CollapsingMesh {
public:
    /// The mesh must outlive it; it stays as it is.
    explicit CollapsingMesh(const PolygonMesh& mesh);

    const Vec3& at(Index v) const { return positions_[v]; }
    std::size_t vertex_count() const { return positions_.size(); }
    std::size_t side_count() const { return corners_.size(); }
    bool is_gone(Index side) const { return corners_[side] == no_index; }
    Index start(Index side) const { return corners_[side]; }
    Index end(Index side) const { return corners_[next_side(side)]; }
    Index twin(Index side) const { return twin_[side]; }
    bool is_locked(Index v) const { return locked_[v]; }

    /// Per vertex one of the sides that start there, or no_index.
    std::vector<Index> sides_out() const;
    /// The neighbours of a side's start, its end first; false if its facets are not one whole fan.
    bool ring_of(Index side, std::vector<Index>& ring) const;

    /// Whether the start of a side may become its end, at a place: a 2-manifold stays one (link condition),
    /// no facet turns by 40 degrees, none gets thinner than all were. The rings are those of its two ends.
    /// `faces`: the normals that facets there should have, if those are known: then one that has none of them
    /// may turn to have one, one that faces away from one must not grow, and what a vertex amid three others
    /// leaves may be a needle.
    bool may_collapse(const std::vector<Index>& ring, const std::vector<Index>& ring_to, const Vec3& place,
                      std::span<const Vec3> faces = {}) const;
    /// Makes the start of a side its end, at a place, if that may be; false if it may not.
    bool collapse(Index side, const Vec3& place, std::span<const Vec3> faces = {});

    /// Moves the start of a side by less than its shortest side, if no facet turns by 40 degrees (as above)
    /// or gets thinner than all were.
    bool move(Index side, const Vec3& place, std::span<const Vec3> faces = {});

    /// Lays the edge of a side, which is not gone, between the two vertices opposite, if they have none yet,
    /// the one that faces the side is no border vertex, neither gets more than 64 facets, and the edge's ends
    /// keep three. Whether the two triangles are better so is for the caller to know. The new edge is that of
    /// previous_side(side).
    bool flip(Index side);
    /// Puts back the edge that was flipped last of those that are not back; `laid`: a side of the new one.
    void take_back_flip(Index laid) { turn_edge(laid); }

    /// Flips the edge of a side beside a triangle that faces away from one of `faces`, if both then face
    /// along one, however thin they are: where leaves' vertices have passed each other, the surface lies
    /// folded on itself.
    bool unfold(Index side, std::span<const Vec3> faces);

    /// Has the vertex a facet that is not what it was when changes were forgotten? All have at first.
    bool has_changed(Index v) const { return changed_[v]; }
    void forget_changes() { changed_.assign(changed_.size(), 0); }

    /// Facets that nothing touched whole, others as triangles. To be called once, at the end.
    CollapsedMesh write();

private:
    void lock_facets();
    bool is_link(const std::vector<Index>& from, const std::vector<Index>& to) const;
    bool spares(Index v) const { return facets_[v] > (border_[v] ? 1u : 3u); }
    bool suits_ring(const Vec3& place, const std::vector<Index>& ring, Index centre,
                    std::span<const Vec3> faces, double& thinnest, double& thinnest_new) const;
    void touch(Index side);
    void remove(Index side);
    void turn_edge(Index side);

    const PolygonMesh& mesh_; // whose facets they are
    std::vector<Vec3> positions_;
    std::vector<Index> stands_for_;
    std::vector<Index> corners_, twin_;           // per side of a triangle; no_index: it is gone
    std::vector<Index> facet_;                    // per triangle
    std::vector<Index> facets_;                   // per vertex, how many
    std::vector<std::uint8_t> border_, locked_;   // per vertex
    std::vector<std::uint8_t> changed_, touched_; // per vertex; per facet
    std::vector<std::uint8_t> flipped_;           // per vertex
    std::vector<Index> ring_, ring_to_, sides_;   // of one collapse
};

} // namespace hsdm
