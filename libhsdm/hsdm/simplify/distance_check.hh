#pragma once
// Where a coarse mesh is farther from a fine one, or from points, than a bound.

#include "hsdm/simplify/unchanged.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <optional>

namespace hsdm {

/// Places of one mesh that are farther from the other than the bound.
struct FarPlaces {
    std::vector<Index> fine_vertices; ///< farther than twice the bound
    std::vector<Index> vertices;      ///< of the coarse mesh
    std::vector<Index> facets;        ///< of the coarse mesh
    std::vector<Vec3> on_facets;      ///< a place on each of them

    std::size_t size() const { return fine_vertices.size() + vertices.size() + facets.size(); }
};

struct FarPoints {
    /// Points that the coarse mesh is to blame for: farther than the bound although the fine mesh is not; and
    /// of those that the fine mesh misses too the ones farther than any of these is from the fine mesh.
    std::vector<Index> points;
    std::size_t beyond = 0;             ///< number of all points farther than the bound
    std::size_t unreachable = 0;        ///< of these, farther than the bound from the fine mesh too
    Index first_unreachable = no_index; ///< the first of the latter
};

/// Compares one mesh after the other with the same fine mesh and points, and measures again only what has
/// changed.
class DistanceCheck {
public:
    /// `fine` and `points` must outlive this; bound > 0. `spacing` > 0: largest distance between sample
    /// places on a facet. `cells`: those of the fine mesh, which then must outlive this, or null.
    DistanceCheck(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                  double bound, double spacing);

    /// `same`: what the mesh has of the one last compared.
    FarPlaces find_far(const PolygonMesh& mesh, const Unchanged& same);

    /// For find_far_points() alone; no find_far() may follow, which would miss what this mesh changed.
    void set_mesh(const PolygonMesh& mesh, const Unchanged& same);

    /// Compares the points with the mesh last given to find_far() or set_mesh(). To be called once after
    /// each.
    FarPoints find_far_points();
    Index nearest_facet(const Vec3& place) const { return to_mesh_->tree().nearest_facet(place); }
    const Vec3& point(Index p) const { return points_[p]; }
    const SurfaceWalk& to_fine() const { return to_fine_; }

private:
    /// What a triangle of the mesh before corresponds to in this one.
    struct Followed {
        Index same = no_index; ///< the triangle with the same corners, if any
        Index near = no_index; ///< else one near its middle, or at least on the way there
    };

    void follow_triangles(const SurfaceWalk& before, const Triangulation& cut_before, const Unchanged& same);
    std::vector<Index> far_from(std::span<const Vec3> places, double bound, std::vector<Index>& near) const;
    std::vector<Index> far_vertices(const PolygonMesh& mesh, const Unchanged& same);
    void find_far_facets(const PolygonMesh& mesh, const Unchanged& same, FarPlaces& far);
    void measure_to_fine(const std::vector<Index>& far);

    const PolygonMesh& fine_;
    std::span<const Vec3> points_;
    double bound_, spacing_;
    Triangulation cut_; // of the mesh; of the fine mesh until the first find_far()
    SurfaceWalk to_fine_;
    std::optional<SurfaceWalk> to_mesh_;
    std::vector<Followed> followed_; // per triangle of the mesh before
    // of the mesh last compared: per vertex and facet, is it near the fine mesh? per vertex, is it at a
    // border?
    std::vector<std::uint8_t> vertex_is_near_, facet_is_near_, border_;
    // per fine vertex, per point: a triangle of the mesh near it, or no_index
    std::vector<Index> near_vertex_, near_point_;
    std::vector<double> off_fine_; // per point, its distance from the fine mesh; -1: not measured yet
};

} // namespace hsdm
