#pragma once
// Tests whether places lie within a bound of a surface, for places that follow each other along it.

#include "hsdm/spatial/facet_cells.hh"
#include "hsdm/spatial/mesh_distance.hh"

#include <memory>

namespace hsdm {

/// Looks for a near enough triangle by walking over sides from the one found for the place before. Only where
/// the walk fails it searches the cells of the facets or, without such cells, the tree. Several times faster
/// than the tree alone if successive places are a few triangles apart.
class SurfaceWalk {
public:
    explicit SurfaceWalk(const PolygonMesh& mesh);
    /// O(t log t), parallel. The arguments need not outlive it.
    SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut,
                TriangleTree::Order order = TriangleTree::Order::compact);
    /// With cells of the mesh that are usable(). O(t), parallel; the tree is built when it is asked for. Mesh
    /// and cells must outlive it.
    SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, const FacetCells& cells);
    ~SurfaceWalk();
    SurfaceWalk(SurfaceWalk&&) noexcept;

    /// A triangle of the cut mesh no farther than `bound` >= 0, or no_index if there is none. `hint` is
    /// no_index or what a call of this surface left there, best for a place nearby; which triangle is found
    /// depends on it.
    Index triangle_within(const Vec3& place, double bound, Index& hint) const;
    bool is_beyond(const Vec3& place, double bound, Index& hint) const {
        return triangle_within(place, bound, hint) == no_index;
    }
    /// Is the part of the surface that a walk from `hint` leads to within `bound`? Another part may be, but
    /// is searched for only if the walk is too long or meets a flat triangle; that is faster where many
    /// places are far.
    bool leads_within(const Vec3& place, double bound, Index& hint) const;
    /// Distance to the nearest triangle; any distance of at most `enough` to some triangle may be returned
    /// instead, which is faster.
    double distance(const Vec3& place, Index& hint, double enough = 0) const;
    /// The vertices of a triangle of the cut mesh.
    const Triangle& corners(Index triangle) const { return triangles_[triangle]; }
    Vec3 middle(Index triangle) const {
        const auto& [a, b, c] = triangles_[triangle];
        return (positions_[a] + positions_[b] + positions_[c]) / 3;
    }
    /// The tree over the same triangles. From any thread.
    const MeshDistance& tree() const;

private:
    enum class End { near, far, lost };
    struct Walked {
        Index triangle;
        End end;
    };
    void make_steps(const std::vector<Index>& twin); // per side of a triangle
    Walked walk(const Vec3& place, double bound, Index from) const;
    End at_end(const Vec3& place, double bound, Index triangle) const;
    double squared_distance(const Vec3& place, Index triangle) const;

    struct Found {
        Index triangle = no_index;
        double squared = std::numeric_limits<double>::infinity();
    };
    Found search_cells(const Vec3& place, double reach, double enough) const;
    bool is_in_reach(double distance) const;
    Index search(const Vec3& place, double bound, Index& hint) const;

    std::vector<Vec3> positions_;
    std::vector<Triangle> triangles_;
    const PolygonMesh* mesh_ = nullptr;
    const FacetCells* cells_ = nullptr; // or none
    std::vector<Index> first_;          // with cells: the triangles of each facet
    Vec3 centre_{0, 0, 0};
    float rounding_ = 0;
    struct Step;
    std::unique_ptr<Step[]> steps_; // per triangle
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace hsdm
