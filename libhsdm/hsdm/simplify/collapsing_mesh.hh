#pragma once
// The triangles of a 2-manifold while edges collapse.

#include "hsdm/mesh/editable_triangles.hh"
#include "hsdm/mesh/triangulate.hh"

namespace hsdm {

/// What is left of a mesh after collapses. Vertices that others stand for are isolated.
struct CollapsedMesh {
    PolygonMesh mesh;
    std::vector<Index> stands_for;     ///< per vertex, the one that stands for it now: itself or another
    std::vector<std::uint8_t> flipped; ///< per vertex, was an edge of its triangles laid the other way?
};

/// A mesh, cut into triangles, whose inner vertices merge into neighbours by edge collapses. Facets with a
/// diagonal that is also an edge of other facets stay whole: their vertices are locked. To start over, copy
/// the mesh first.
class CollapsingMesh : private EditableTriangles {
public:
    /// The mesh must outlive this; it is not changed.
    explicit CollapsingMesh(const PolygonMesh& mesh);

    using EditableTriangles::end;
    using EditableTriangles::is_gone;
    using EditableTriangles::opposite;
    using EditableTriangles::ring_of;
    using EditableTriangles::side_count;
    using EditableTriangles::start;
    using EditableTriangles::twin;
    using EditableTriangles::vertex_count;
    const Vec3& at(Index v) const { return positions_[v]; }
    bool is_locked(Index v) const { return locked_[v]; }

    /// Per vertex, one of the sides that start there, or no_index.
    std::vector<Index> sides_out() const;

    /// May the start of a side collapse onto its end, which moves to a place? A 2-manifold must stay one
    /// (link condition), no facet may turn by 40 degrees or get thinner than collapses::least_shape and than
    /// the thinnest there. The rings are those of the two ends. `faces`: the normals that facets there should
    /// have, if known; then a facet that has none of them may turn to one that it should have, a facet that
    /// faces away from one must not grow, and a vertex amid three others may leave a needle.
    bool may_collapse(const std::vector<Index>& ring, const std::vector<Index>& ring_to, const Vec3& place,
                      std::span<const Vec3> faces = {}) const;
    /// Collapses the start of a side onto its end, which moves to a place; false if may_collapse() does not
    /// allow it.
    bool collapse(Index side, const Vec3& place, std::span<const Vec3> faces = {});

    /// Moves the start of a side by less than its shortest side, unless a facet would turn by 40 degrees (as
    /// above) or get thinner than the thinnest there.
    bool move(Index side, const Vec3& place, std::span<const Vec3> faces = {});

    /// Flips the edge of a side that is not gone, so that it joins the two vertices opposite. False at a
    /// border; if both ends or both opposite vertices are locked; if these share an edge already, the one in
    /// the side's triangle has no closed fan, or one has 64 facets; or if an end would keep fewer than three.
    /// Whether the new triangles are better is the caller's concern. The new edge is that of
    /// previous_side(side).
    bool flip(Index side);
    /// Undoes the last flip not undone yet; `laid`: a side of the flipped edge.
    void take_back_flip(Index laid) { lay(laid); }

    /// Flips the edge of a side if one of its two triangles faces away from one of `faces` and both new
    /// triangles face along one, however thin they are. Such folds, flat on themselves, come from vertices of
    /// leaves that have passed each other.
    bool unfold(Index side, std::span<const Vec3> faces);

    /// Has a facet of the vertex changed since forget_changes()? True for all at first.
    bool has_changed(Index v) const { return changed_[v]; }
    void forget_changes() { changed_.assign(changed_.size(), 0); }

    /// The mesh left: facets that nothing touched come out whole, others as triangles. To be called once, at
    /// the end.
    CollapsedMesh write();

private:
    CollapsingMesh(const PolygonMesh& mesh, const Triangulation& cut);
    void lock_facets();
    bool is_link(const std::vector<Index>& from, const std::vector<Index>& to) const;
    bool suits_ring(const Vec3& place, const std::vector<Index>& ring, Index centre,
                    std::span<const Vec3> faces, double& thinnest, double& thinnest_new) const;
    void touch(Index side);
    void lay(Index side);

    const PolygonMesh& mesh_; // the mesh given
    std::vector<Vec3> positions_;
    std::vector<Index> stands_for_;
    std::vector<Index> facet_;                    // per triangle, the facet it was cut from
    std::vector<std::uint8_t> locked_;            // per vertex
    std::vector<std::uint8_t> changed_, touched_; // per vertex; per facet
    std::vector<std::uint8_t> flipped_;           // per vertex
    std::vector<Index> ring_, ring_to_;           // scratch of one collapse
};

} // namespace hsdm
