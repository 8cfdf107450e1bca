#pragma once
// Distance of a point from a mesh, and the nearest triangle.

#include "hsdm/spatial/triangle_tree.hh"

namespace hsdm {

/// Triangles of a mesh in a bounding volume hierarchy. Polygons are cut as the STL writer cuts them.
class MeshDistance {
public:
    /// O(t log t), parallel. The mesh need not outlive it.
    explicit MeshDistance(const PolygonMesh& mesh);
    /// As above, of a mesh that is cut already.
    MeshDistance(const PolygonMesh& mesh, const Triangulation& cut,
                 TriangleTree::Order order = TriangleTree::Order::compact);
    /// Distance from a point to the nearest triangle; infinity if the mesh has no facet.
    double operator()(const Vec3& point) const;
    /// The same; `hint` is no_index or what a call for a point nearby left there. It changes only the time.
    double operator()(const Vec3& point, Index& hint) const;
    /// The facet nearest to a point, or no_index if the mesh has none.
    Index nearest_facet(const Vec3& point) const;
    /// A triangle of the cut mesh no farther than `bound`, or no_index if there is none; several times faster
    /// than distances. `hint` is no_index or what the call for a point nearby left there; which triangle is
    /// found depends on it.
    Index triangle_within(const Vec3& point, double bound, Index& hint) const;
    /// The facet that a triangle of the cut mesh was cut from.
    Index facet_of(Index triangle) const { return facet_[triangle]; }
    bool is_beyond(const Vec3& point, double bound, Index& hint) const {
        return triangle_within(point, bound, hint) == no_index;
    }

    const TriangleTree& tree() const { return tree_; }

private:
    TriangleTree tree_;
    std::vector<Index> facet_; // per triangle
};

} // namespace hsdm
