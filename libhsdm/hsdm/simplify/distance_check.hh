#pragma once
// Where a coarse mesh is farther from a fine one, or from points, than a bound.

#include "hsdm/simplify/content_keys.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <optional>

namespace hsdm {

/// What is farther from the other mesh than the bound.
struct FarPlaces {
    std::vector<Index> fine_vertices; ///< than twice the bound
    std::vector<Index> vertices;      ///< of the coarse mesh
    std::vector<Index> facets;        ///< of the coarse mesh
    std::vector<Vec3> on_facets;      ///< a place on each of them

    std::size_t size() const { return fine_vertices.size() + vertices.size() + facets.size(); }
};

struct FarPoints {
    std::vector<Index> points;   ///< farther than the bound, and than any is from the fine mesh
    std::size_t beyond = 0;      ///< all points farther than the bound
    std::size_t unreachable = 0; ///< ... and from the fine mesh already
};

/// Compares one mesh after the other with the same fine mesh and points, and measures again only what may
/// have changed: triangles of two meshes are the same if their corners are at the same places.
class DistanceCheck {
public:
    /// `fine` and `points` must outlive it; bound > 0. `spacing` > 0: of places looked at on a facet.
    /// `cells`: of the fine mesh, which then must outlive it, or null.
    DistanceCheck(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                  double bound, double spacing);

    FarPlaces find_far(const PolygonMesh& mesh);

    /// From the mesh last compared. To be called once after each find_far().
    FarPoints find_far_points();
    Index nearest_facet(const Vec3& place) const { return to_mesh_->tree().nearest_facet(place); }
    const Vec3& point(Index p) const { return points_[p]; }
    const SurfaceWalk& to_fine() const { return to_fine_; }

private:
    /// What has become of a triangle.
    struct Followed {
        Index same = no_index; ///< the one with the same corners
        Index near = no_index; ///< one that is near its middle, or some way from it
    };

    void follow_triangles(const SurfaceWalk& before, std::span<const Key> keys_before);
    std::vector<Index> far_from(std::span<const Vec3> places, double bound, std::vector<Index>& near) const;
    std::vector<Index> far_vertices(const PolygonMesh& mesh);
    void find_far_facets(const PolygonMesh& mesh, FarPlaces& far);
    void measure_to_fine(const std::vector<Index>& far);

    const PolygonMesh& fine_;
    std::span<const Vec3> points_;
    double bound_, spacing_;
    Triangulation cut_; // of the mesh; before the first one, of the fine mesh
    SurfaceWalk to_fine_;
    std::optional<SurfaceWalk> to_mesh_;
    KeySet fine_names_, fine_keys_;               // of the fine mesh's vertices and triangles
    std::vector<Key> names_, keys_;               // of the mesh's
    std::vector<Followed> followed_;              // per triangle of the mesh before
    KeySet near_names_, near_keys_;               // of those found near the fine mesh
    std::vector<Index> near_vertex_, near_point_; // the triangle that a fine vertex, a point is near to
    std::vector<double> off_fine_;                // per point, from the fine mesh; -1: not known
};

} // namespace hsdm
