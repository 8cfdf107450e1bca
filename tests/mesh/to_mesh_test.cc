#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "support/captured.hh"
#include "support/meshes.hh"

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <catch2/catch.hpp>

#include <cmath>
#include <sstream>

using namespace hsdm;
using support::mesh_of;
using support::unit_cube;

namespace {

bool is_sound(PolyMesh& mesh) {
    std::ostringstream report;
    const bool sound = OpenMesh::Utils::MeshCheckerT<PolyMesh>(mesh).check(
        OpenMesh::Utils::MeshCheckerT<PolyMesh>::CHECK_ALL, report);
    INFO(report.str());
    CHECK(report.str().empty());
    return sound;
}

std::vector<std::vector<Index>> facet_lists(const PolygonMesh& mesh) {
    std::vector<std::vector<Index>> lists;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        lists.emplace_back(mesh.facet(f).begin(), mesh.facet(f).end());
    return lists;
}

} // namespace

TEST_CASE("a cube becomes a closed half-edge mesh with outward facet normals") {
    auto [mesh, rejected, split] = to_mesh(unit_cube());
    CHECK(rejected == 0);
    CHECK(split == 0);
    CHECK(mesh.n_vertices() == 8);
    CHECK(mesh.n_edges() == 12);
    CHECK(mesh.n_faces() == 6);
    CHECK(is_sound(mesh));
    for (const auto h : mesh.halfedges()) CHECK_FALSE(mesh.is_boundary(h));
    for (const auto f : mesh.faces())
        CHECK((mesh.normal(f) | (mesh.calc_face_centroid(f) - Vec3(.5, .5, .5))) == Approx(0.5));
}

TEST_CASE("polygons come back from the mesh as they went in") {
    PolygonMesh in = unit_cube();
    in.normals.assign(8, Vec3(0, 0, 1));
    in.properties.push_back({"hsdm_vertex_class", VertexProperty::Type::uint8, {2, 1, 0, 2, 2, 1, 2, 0}});
    in.properties.push_back({"hsdm_level", VertexProperty::Type::int32, std::vector<double>(8, -5)});
    in.properties.push_back({"quality", VertexProperty::Type::float64, std::vector<double>(8, 0.1)});
    const PolygonMesh out = to_polygons(to_mesh(in).mesh);
    CHECK(out.positions == in.positions);
    CHECK(out.normals == in.normals);
    CHECK(facet_lists(out) == facet_lists(in));
    REQUIRE(out.properties.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(out.properties[i].name == in.properties[i].name);
        CHECK(out.properties[i].type == in.properties[i].type);
        CHECK(out.properties[i].values == in.properties[i].values);
    }
}

TEST_CASE("vertex normals of a mesh that was given none are zero") {
    // Memory that was used before: a mesh of as many vertices with normals, which is gone.
    PolygonMesh in = unit_cube();
    in.normals.assign(8, Vec3(7, 8, 9));
    { const PolyMesh before = to_mesh(in).mesh; }
    in.normals.clear();
    const PolyMesh mesh = to_mesh(in).mesh;
    for (const auto v : mesh.vertices()) CHECK(mesh.normal(v) == Vec3(0, 0, 0));
}

TEST_CASE("a property without a name is one like any other") {
    PolygonMesh in = unit_cube();
    in.properties.push_back({"", VertexProperty::Type::float64, std::vector<double>(8, 0.5)});
    const PolygonMesh out = to_polygons(to_mesh(in).mesh);
    REQUIRE(out.properties.size() == 1);
    CHECK(out.properties[0].name.empty());
    CHECK(out.properties[0].values == in.properties[0].values);
}

TEST_CASE("a property that has the name of the mesh's points leaves these alone") {
    PolygonMesh cube = unit_cube();
    for (const char* name : {"v:points", "v:normals", "v:status"})
        cube.properties.push_back({name, VertexProperty::Type::float64, std::vector<double>(8, 7)});
    PolyMesh mesh = to_mesh(cube).mesh;
    CHECK(to_polygons(mesh).positions == cube.positions);
    CHECK(is_sound(mesh));
}

TEST_CASE("a vertex's three normals survive the way to polygons and back") {
    PolyMesh mesh = to_mesh(unit_cube()).mesh;
    {
        auto normals = kept_vertex_property<VertexNormalsT<PolyMesh>>(mesh, vertex_normals_property);
        for (const auto v : mesh.vertices()) normals[v] = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)};
    }
    const PolygonMesh polygons = to_polygons(mesh);
    CHECK(polygons.properties.size() == 9);
    PolyMesh again = to_mesh(polygons).mesh;
    REQUIRE(OpenMesh::hasProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(again, "hsdm_normals"));
    const auto normals =
        OpenMesh::getProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(again, "hsdm_normals");
    for (const auto v : again.vertices())
        CHECK(normals[v] == VertexNormalsT<PolyMesh>{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)});
}

TEST_CASE("property values beyond their type's range become its limits") {
    PolygonMesh in = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    in.properties.push_back({"a", VertexProperty::Type::uint8, {300, -4, std::nan("")}});
    in.properties.push_back({"b", VertexProperty::Type::int32, {1e12, -1e12, 7}});
    const PolygonMesh out = to_polygons(to_mesh(in).mesh);
    CHECK(out.properties[0].values == std::vector<double>{255, 0, 0});
    CHECK(out.properties[1].values == std::vector<double>{2147483647, -2147483648.0, 7});
}

TEST_CASE("isolated vertices are left out and the others keep their order") {
    PolygonMesh facets = mesh_of({{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}}, {{1, 3, 4}});
    const auto result = to_mesh(facets);
    REQUIRE(result.mesh.n_vertices() == 3);
    CHECK(to_polygons(result.mesh).positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("facets that would break the 2-manifold are counted and OpenMesh prints nothing") {
    const support::Captured captured;
    PolygonMesh facets = unit_cube();
    facets.add_facet(std::vector<Index>{0, 2, 3});                      // a third facet at an edge
    facets.add_facet(std::vector<Index>{0, 2, 3, 1});                   // one twice
    facets.add_facet(std::vector<Index>{0, 0, 3});                      // a vertex twice
    facets.add_facet(std::vector<Index>{0, 1});                         // two vertices
    facets.add_facet(std::vector<Index>{0, 1, 99});                     // a vertex that does not exist
    facets.add_facet(std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 1, 2}); // long, a vertex twice
    auto result = to_mesh(facets);
    CHECK(result.rejected == 6);
    CHECK(result.mesh.n_faces() == 6);
    CHECK(is_sound(result.mesh));
    CHECK(captured.text().empty());
}

TEST_CASE("a rejected facet does not keep later ones from its other edges") {
    const auto result = to_mesh(
        mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2}, {0, 1, 3}, {1, 3, 4}}));
    CHECK(result.rejected == 1);
    CHECK(result.mesh.n_faces() == 2);
}

TEST_CASE("fans that meet in a vertex only get a vertex each") {
    PolygonMesh facets =
        mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}});
    auto open = to_mesh(facets);
    CHECK(open.split_vertices == 1);
    CHECK(open.mesh.n_vertices() == 6);
    CHECK(open.mesh.point(OpenMesh::VertexHandle(5)) == Vec3(0, 0, 0));
    CHECK(is_sound(open.mesh));

    // Two tetrahedra with a common tip.
    auto closed = to_mesh(
        mesh_of({{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}},
                {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {0, 5, 4}, {0, 6, 5}, {0, 4, 6}, {4, 5, 6}}));
    CHECK(closed.rejected == 0);
    CHECK(closed.split_vertices == 1);
    CHECK(is_sound(closed.mesh));
    for (const auto h : closed.mesh.halfedges()) CHECK_FALSE(closed.mesh.is_boundary(h));
}

TEST_CASE("boundary loops are linked: an open grid has one, as long as its rim") {
    constexpr Index n = 5;
    const PolygonMesh facets = support::quad_sheet(n, n, [](Index x, Index y) { return Vec3(x, y, 0); });
    auto [mesh, rejected, split] = to_mesh(facets);
    CHECK(rejected + split == 0);
    CHECK(is_sound(mesh));
    OpenMesh::HalfedgeHandle begin;
    for (const auto h : mesh.halfedges())
        if (mesh.is_boundary(h)) begin = h;
    std::size_t length = 0;
    OpenMesh::HalfedgeHandle h = begin;
    do {
        h = mesh.next_halfedge_handle(h);
        ++length;
    } while (h != begin && length < 1000);
    CHECK(length == 4 * n);
    // As add_face would have left it: vertices on the rim point to a boundary half-edge.
    for (const auto v : mesh.vertices())
        if (mesh.is_boundary(v)) CHECK(mesh.is_boundary(mesh.halfedge_handle(v)));
}

TEST_CASE("nothing becomes an empty mesh") {
    CHECK(to_mesh({}).mesh.n_faces() == 0);
    CHECK(to_polygons(PolyMesh()).facet_count() == 0);
}

TEST_CASE("deleted elements do not come back as polygons") {
    PolyMesh mesh = to_mesh(unit_cube()).mesh;
    mesh.delete_face(OpenMesh::FaceHandle(2), true);
    const PolygonMesh polygons = to_polygons(mesh);
    CHECK(polygons.facet_count() == 5);
    CHECK(polygons.vertex_count() == 8);
    CHECK(to_mesh(polygons).rejected == 0);
}

TEST_CASE("normals and properties that do not fit the vertices are never read beyond their end") {
    PolygonMesh polygons = unit_cube();
    polygons.properties.push_back({"hsdm_normals_0_x", VertexProperty::Type::float32, {1}});
    polygons.properties.push_back({"short", VertexProperty::Type::float64, {1}});
    CHECK(to_mesh(polygons).rejected == 0);
    polygons.normals.assign(3, Vec3(0, 0, 1));
    CHECK_THROWS_WITH(to_mesh(polygons),
                      "the mesh holds 3 normals for 8 vertices; give one for each, or leave them out");
}
