#include "features/meshes.hh"
#include "hsdm/ReconstructorT.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

namespace {

/// Only vertices, as a scan is.
template <class Mesh>
void add_points(Mesh& mesh, const PolygonMesh& shape) {
    for (const Vec3& p : shape.positions) mesh.add_vertex(to_normal<typename Mesh::Point>(p));
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a mesh's vertices become a surface in the same mesh", "", EVERY_KIND_OF_MESH) {
    TestType mesh;
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_vertex_normals();
    OpenMesh::VPropHandleT<int> mine;
    mesh.add_property(mine, "mine");
    add_points(mesh, sphere(40));
    for (const auto v : mesh.vertices()) {
        mesh.property(mine, v) = 7;
        mesh.set_normal(v, to_normal<typename TestType::Normal>(
                               Vec3(mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2])));
    }

    ReconstructorT<TestType> reconstructor(mesh);
    ReconstructOptions options;
    options.depth = 3;
    reconstructor.initialize(options);
    const Report report = reconstructor.reconstruct();

    REQUIRE(mesh.n_faces() > 50);
    CHECK(report.input.points == sphere(40).vertex_count());
    CHECK(mesh.n_vertices() >= report.mesh.vertices);
    for (const auto v : mesh.vertices()) {
        CHECK(mesh.point(v).norm() == Approx(1).margin(0.3));
        CHECK((mesh.normal(v) | mesh.point(v)) > 0.5);
        CHECK(mesh.property(mine, v) == 0);
    }
    for (const auto f : mesh.faces())
        if (TestType::is_trimesh()) CHECK(mesh.valence(f) == 3);
    CHECK(OpenMesh::hasProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_vertex_class"));
    CHECK(OpenMesh::hasProperty<VertexHandle, VertexNormalsT<TestType>>(mesh, "hsdm_normals"));
}

TEST_CASE("reconstructing before initialize throws, and a failure leaves the mesh as it was") {
    TriMeshF mesh = build<TriMeshF>(cube(1));
    ReconstructorT<TriMeshF> reconstructor(mesh);
    CHECK_THROWS_AS(reconstructor.reconstruct(), std::logic_error);
    ReconstructOptions options;
    options.depth = 40;
    reconstructor.initialize(options);
    CHECK_THROWS_AS(reconstructor.reconstruct(), OptionError);
    CHECK(mesh.n_vertices() == 8);
    CHECK(mesh.n_faces() == 12);
}
