#include "features/meshes.hh"
#include "hsdm/ReconstructorT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <catch2/catch.hpp>

#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

TEST_CASE("cut into triangles, a mesh keeps its features and properties") {
    PolyMesh quads = to_mesh(support::divided_cube(3)).mesh;
    quads.add_vertex({9, 9, 9}); // isolated: left out
    classify_features(quads);
    const PolyMesh triangles = triangle_mesh(quads);
    CHECK(triangles.n_faces() == 2 * quads.n_faces());
    CHECK(triangles.n_vertices() + 1 == quads.n_vertices());
    CHECK(feature_lines(triangles).size() == feature_lines(quads).size());
    std::size_t sharp = 0;
    for (const auto e : triangles.edges()) sharp += triangles.status(e).feature();
    CHECK(sharp == 36);
    for (const auto v : triangles.vertices())
        CHECK(triangles.status(v).feature() == quads.status(v).feature());
    CHECK_FALSE(OpenMesh::hasProperty<VertexHandle, std::int32_t>(triangles, "hsdm_source"));
}

TEST_CASE("where vertices go with facets that cancel out, no diagonal gets an edge's mark") {
    PolygonMesh polygons = support::mesh_of({{7, 0, 0}, {8, 0, 0}, {7, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
    PolygonMesh cube = support::unit_cube();
    for (Vec3& p : cube.positions) p[1] += 0.3 * p[2]; // two of its sides are cut from 2 to 4 and from 3 to 5
    polygons.positions.insert(polygons.positions.end(), cube.positions.begin(), cube.positions.end());
    for (std::size_t f = 0; f < cube.facet_count(); ++f) {
        std::vector<Index> facet(cube.facet(f).begin(), cube.facet(f).end());
        for (Index& v : facet) v += 3;
        polygons.add_facet(facet);
    }
    PolyMesh quads = to_mesh(polygons).mesh;
    REQUIRE(quads.n_faces() == 8);
    for (const auto e : quads.edges()) quads.status(e).set_feature(true);
    const PolyMesh triangles = triangle_mesh(quads);
    REQUIRE(triangles.n_vertices() == 8);
    std::size_t sharp = 0;
    for (const auto e : triangles.edges()) sharp += triangles.status(e).feature();
    CHECK(sharp == 12);
}

TEST_CASE("two facets cut by the same diagonal stay a 2-manifold") {
    // Two quads back to back over the same corners but one: both would be cut from 0 to 2.
    PolygonMesh pillow;
    pillow.positions = {{0, 0, 0}, {1, -0.1, 0}, {0.2, 0.2, 0}, {-0.1, 1, 0}};
    pillow.positions.emplace_back(-0.1, 1, 0.5);
    pillow.add_facet(std::vector<Index>{0, 1, 2, 3});
    pillow.add_facet(std::vector<Index>{2, 1, 0, 4});
    PolyMesh quads = to_mesh(pillow).mesh;
    REQUIRE(quads.n_faces() == 2);
    PolyMesh triangles = triangle_mesh(quads);
    std::ostringstream report;
    CHECK(OpenMesh::Utils::MeshCheckerT<PolyMesh>(triangles).check(
        OpenMesh::Utils::MeshCheckerT<PolyMesh>::CHECK_ALL, report));
    CHECK(report.str().empty());
}

TEMPLATE_TEST_CASE("a mesh is copied into the caller's traits with status, normals and properties", "",
                   PolyMeshF, PolyMeshD, TriMeshF, TriMeshD) {
    PolyMesh from = to_mesh(support::divided_cube(2)).mesh;
    classify_features(from);
    smooth_normals(from);
    if (TestType::is_trimesh()) from = triangle_mesh(from);
    TestType to = build<TestType>(sphere(3)); // what it held is gone
    copy_mesh(from, to);
    CHECK(to.n_vertices() == from.n_vertices());
    CHECK(to.n_edges() == from.n_edges());
    CHECK(to.n_faces() == from.n_faces());
    std::ostringstream report;
    CHECK(OpenMesh::Utils::MeshCheckerT<TestType>(to).check(
        OpenMesh::Utils::MeshCheckerT<TestType>::CHECK_ALL, report));
    const auto classes = OpenMesh::getProperty<VertexHandle, std::uint8_t>(to, "hsdm_vertex_class");
    const auto counts = OpenMesh::getProperty<VertexHandle, std::uint8_t>(to, "hsdm_normal_count");
    const auto normals = OpenMesh::getProperty<VertexHandle, VertexNormalsT<TestType>>(to, "hsdm_normals");
    for (const auto v : to.vertices()) {
        CHECK(to_vec3(to.point(v)) == from.point(v));
        CHECK(classes[v] + 1 == counts[v]);
        CHECK((to_vec3(to.normal(v)) - from.normal(v)).norm() < 1e-6);
        for (std::size_t k = 0; k < counts[v]; ++k) CHECK(normals[v][k].norm() == Approx(1));
    }
    for (const auto e : to.edges()) CHECK(to.status(e).feature() == from.status(e).feature());
}
