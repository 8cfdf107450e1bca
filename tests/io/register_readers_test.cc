#include "features/meshes.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/register_readers.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/mesh_types.hh"
#include "io/temp_file.hh"
#include "support/captured.hh"
#include "support/meshes.hh"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <catch2/catch.hpp>

#include <sstream>

using namespace hsdm;
using hsdm::test::TempFile;
using OpenMesh::IO::Options;

TEST_CASE("OpenMesh reads point files in double precision once the readers are registered", "[io]") {
    register_readers();
    register_readers();
    const TempFile file("a.xyz", "0.1234567890123456 10000000.001 3 0 0.6 0.8\n4 5 6 1 0 0\n");
    PolyMesh mesh;
    Options options = Options::VertexNormal;
    REQUIRE(OpenMesh::IO::read_mesh(mesh, file.path(), options));
    REQUIRE(mesh.n_vertices() == 2);
    CHECK(mesh.n_faces() == 0);
    CHECK(mesh.point(mesh.vertex_handle(0)) == Vec3(0.1234567890123456, 10000000.001, 3));
    CHECK(mesh.normal(mesh.vertex_handle(0)) == Vec3(0, 0.6, 0.8));
    CHECK(options.vertex_has_normal());
    CHECK_FALSE(options.vertex_has_color());
}

TEST_CASE("OpenMesh gets normals and colours only where the file has them and the caller asked", "[io]") {
    register_readers();
    const TempFile file("a.pts", "2\n1 2 3 -7 10 20 30\n4 5 6 -8 40 50 60\n");
    PolyMesh mesh;
    mesh.request_vertex_colors();
    Options options = Options::VertexNormal | Options::VertexColor;
    REQUIRE(OpenMesh::IO::read_mesh(mesh, file.path(), options));
    CHECK_FALSE(options.vertex_has_normal());
    CHECK(options.vertex_has_color());
    const auto color = OpenMesh::color_cast<OpenMesh::Vec3uc>(mesh.color(mesh.vertex_handle(1)));
    CHECK(color == OpenMesh::Vec3uc(40, 50, 60));

    PolyMesh bare;
    Options none;
    REQUIRE(OpenMesh::IO::read_mesh(bare, file.path(), none));
    CHECK_FALSE(none.vertex_has_color());
}

TEST_CASE("OpenMesh is told of a bad point file by false, and reads streams too", "[io]") {
    register_readers();
    PolyMesh mesh;
    CHECK_FALSE(OpenMesh::IO::read_mesh(mesh, TempFile("a.xyz", "1 2 x\n").path()));
    std::istringstream stream("1 2 3\n4 5 6\n7 8 9\n");
    Options options;
    REQUIRE(OpenMesh::IO::read_mesh(mesh, stream, ".xyz", options));
    CHECK(mesh.n_vertices() == 3);
}

TEST_CASE("registering point readers leaves OpenMesh's own formats alone", "[io]") {
    register_readers();
    const TempFile file("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    PolyMesh mesh;
    REQUIRE(OpenMesh::IO::read_mesh(mesh, file.path()));
    CHECK(mesh.n_vertices() == 3);
    CHECK(mesh.n_faces() == 1);
}

TEST_CASE("OpenMesh reads every property of an .om file without a word", "[io]") {
    register_readers();
    PolyMesh mesh = to_mesh(support::divided_cube(2)).mesh;
    classify_features(mesh);
    const TempFile file("a.om", "");
    write_om(file.path(), mesh);
    const support::Captured captured; // where omerr() writes
    PolyMesh back;
    REQUIRE(OpenMesh::IO::read_mesh(back, file.path()));
    CHECK(captured.text().empty());
    for (const char* name : {vertex_class_property, normal_count_property})
        CHECK(OpenMesh::hasProperty<OpenMesh::VertexHandle, std::uint8_t>(back, name));
    REQUIRE(OpenMesh::hasProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(back, "hsdm_normals"));
    const OpenMesh::VProp<VertexNormalsT<PolyMesh>> normals(back, "hsdm_normals"),
        before(mesh, "hsdm_normals");
    for (const auto v : mesh.vertices()) CHECK(normals[v] == before[v]);
}
