#include "hsdm/spatial/mesh_distance.hh"

#include <cmath>

namespace hsdm {

MeshDistance::MeshDistance(const PolygonMesh& mesh) : MeshDistance(mesh, triangulate(mesh)) {}

MeshDistance::MeshDistance(const PolygonMesh& mesh, const Triangulation& cut, TriangleTree::Order order)
    : tree_(mesh.positions, cut.triangles, order), facet_(facet_of_triangle(cut)) {}

double MeshDistance::operator()(const Vec3& point) const {
    return std::sqrt(tree_.nearest(point).squared);
}

double MeshDistance::operator()(const Vec3& point, Index& hint) const {
    const TriangleTree::Nearest nearest = tree_.nearest(point, hint);
    hint = nearest.triangle;
    return std::sqrt(nearest.squared);
}

Index MeshDistance::nearest_facet(const Vec3& point) const {
    const Index triangle = tree_.nearest(point).triangle;
    return triangle == no_index ? no_index : facet_[triangle];
}

Index MeshDistance::triangle_within(const Vec3& point, double bound, Index& hint) const {
    const TriangleTree::Nearest found = tree_.within(point, bound, hint);
    if (found.triangle == no_index) return no_index;
    hint = found.triangle;
    return std::sqrt(found.squared) <= bound ? found.triangle : no_index;
}

} // namespace hsdm
