#include "hsdm/mesh/triangle_mesh.hh"

#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/triangulate.hh"

#include <numeric>

namespace hsdm {
namespace {

PolygonMesh cut(PolygonMesh polygons) {
    const Triangulation cuts = triangulate(polygons);
    polygons.corners.clear();
    polygons.first.assign(1, 0);
    polygons.corners.reserve(3 * cuts.size());
    polygons.first.reserve(cuts.size() + 1);
    for (const Triangle& triangle : cuts.triangles) polygons.add_facet(triangle);
    make_manifold(polygons);
    return polygons;
}

/// The name under which each triangle vertex carries the vertex it comes from.
constexpr const char* source_property = "hsdm_source";

/// Vertices as to_polygons numbers them.
std::vector<OpenMesh::VertexHandle> used_vertices(const PolyMesh& mesh) {
    std::vector<OpenMesh::VertexHandle> used;
    for (const auto v : mesh.vertices())
        if (!mesh.is_isolated(v)) used.push_back(v);
    return used;
}

void copy_status(const PolyMesh& from, const std::vector<OpenMesh::VertexHandle>& used, PolyMesh& to) {
    OpenMesh::VPropHandleT<std::int32_t> property;
    if (!to.get_property_handle(property, source_property)) return;
    const auto source = [&](OpenMesh::VertexHandle v) {
        return used[static_cast<std::size_t>(to.property(property, v))];
    };
    for (const auto v : to.vertices()) to.status(v) = from.status(source(v));
    for (const auto e : to.edges()) {
        const auto h = from.find_halfedge(source(e.v0()), source(e.v1()));
        if (h.is_valid()) to.status(e) = from.status(h.edge());
    }
    to.remove_property(property);
}

} // namespace

PolyMesh triangle_mesh(const PolyMesh& mesh) {
    const std::vector<OpenMesh::VertexHandle> used = used_vertices(mesh);
    PolygonMesh polygons = to_polygons(mesh);
    polygons.sharp_edges.clear(); // copy_status sets the marks
    std::vector<double> numbers(used.size());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    polygons.properties.push_back({source_property, VertexProperty::Type::int32, std::move(numbers)});
    PolyMesh triangles = to_mesh(cut(std::move(polygons))).mesh;
    copy_status(mesh, used, triangles);
    return triangles;
}

} // namespace hsdm
