#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "io/temp_file.hh"
#include "support/meshes.hh"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <catch2/catch.hpp>

#include <algorithm>
#include <initializer_list>
#include <memory>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Has OpenMesh write the mesh, its status bits too.
template <class Mesh>
bool write_by_openmesh(const Mesh& mesh, const std::string& path, OpenMesh::IO::Options options) {
    options += OpenMesh::IO::Options::Binary;
    options += OpenMesh::IO::Options::Status;
    omlog().disable();
    const bool written = OpenMesh::IO::write_mesh(mesh, path, options);
    omlog().enable();
    return written;
}

/// A cube with classes, normals and sharp edges.
PolyMesh classified_cube() {
    PolyMesh mesh = to_mesh(support::divided_cube(4)).mesh;
    classify_features(mesh);
    smooth_normals(mesh);
    return mesh;
}

void check_equal(const PolygonMesh& a, const PolygonMesh& b) {
    CHECK(a.positions == b.positions);
    CHECK(a.normals == b.normals);
    CHECK(a.corners == b.corners);
    CHECK(a.first == b.first);
    CHECK(a.sharp_edges == b.sharp_edges);
    REQUIRE(a.properties.size() == b.properties.size());
    for (const VertexProperty& property : a.properties) { // in whatever order
        INFO(property.name);
        const auto same =
            std::find_if(b.properties.begin(), b.properties.end(),
                         [&](const VertexProperty& other) { return other.name == property.name; });
        REQUIRE(same != b.properties.end());
        CHECK(property.type == same->type);
        CHECK((property.values == same->values));
    }
}

} // namespace

TEST_CASE(".om reads back as it was written: mesh, properties and sharp edges", "[mesh_io]") {
    const PolyMesh mesh = classified_cube();
    const PolygonMesh polygons = to_polygons(mesh);
    REQUIRE(polygons.sharp_edges.size() == 48);
    const TempFile by_mesh("a.om", ""), by_polygons("b.om", "");
    write_om(by_mesh.path(), mesh);
    check_equal(read_mesh(by_mesh.path()), polygons);
    write_mesh(by_polygons.path(), polygons, MeshFormat::om);
    check_equal(read_mesh(by_polygons.path()), polygons);
}

TEST_CASE("a mesh has the feature bits of the polygons it is made of", "[mesh_io]") {
    const PolyMesh mesh = classified_cube(), again = to_mesh(to_polygons(mesh)).mesh;
    CHECK(feature_lines(again) == feature_lines(mesh));
    for (const auto v : mesh.vertices()) CHECK(again.status(v).feature() == mesh.status(v).feature());
}

TEST_CASE(".om that OpenMesh writes of other meshes is read", "[mesh_io]") {
    TriMeshF mesh = build<TriMeshF>(support::divided_sphere(3));
    mesh.request_vertex_colors();
    for (const auto v : mesh.vertices()) mesh.set_color(v, {1, 2, static_cast<unsigned char>(v.idx())});
    for (const auto v : mesh.vertices()) mesh.set_normal(v, mesh.point(v));
    mesh.status(OpenMesh::EdgeHandle(5)).set_feature(true);
    const TempFile file("a.om", "");
    using OpenMesh::IO::Options;
    REQUIRE(write_by_openmesh(mesh, file.path(), Options::VertexNormal | Options::VertexColor));
    const PolygonMesh read = read_mesh(file.path());
    CHECK(read.vertex_count() == mesh.n_vertices());
    CHECK(read.facet_count() == mesh.n_faces());
    CHECK(read.normals.size() == mesh.n_vertices());
    CHECK(read.sharp_edges.size() == 1);
    REQUIRE(read.properties.size() == 3);
    CHECK(read.properties[2].name == "blue");
    CHECK(read.properties[2].values[7] == 7);
    CHECK(to_mesh(read).rejected == 0);
    const PointFile points = read_points(file.path());
    CHECK(points.format == "om");
    CHECK(points.faces == mesh.n_faces());
    CHECK(points.cloud.positions == read.positions);
    CHECK(points.cloud.normals.size() == mesh.n_vertices());
}

TEST_CASE("deleted vertices, which OpenMesh writes to .om, are no points", "[mesh_io]") {
    TriMeshF mesh = build<TriMeshF>(support::divided_sphere(3));
    for (const auto v : mesh.vertices()) mesh.set_normal(v, mesh.point(v));
    const OpenMesh::VertexHandle deleted(7);
    const auto place = OpenMesh::vector_cast<Vec3>(mesh.point(deleted));
    const std::size_t vertices = mesh.n_vertices(), facets = mesh.n_faces() - mesh.valence(deleted);
    mesh.delete_vertex(deleted);
    const TempFile file("a.om", "");
    REQUIRE(write_by_openmesh(mesh, file.path(), OpenMesh::IO::Options::VertexNormal));
    REQUIRE(read_mesh(file.path()).vertex_count() == vertices); // faces go by their numbers
    const PointFile points = read_points(file.path());
    CHECK(points.faces == facets);
    CHECK(points.cloud.positions.size() == vertices - 1);
    CHECK(std::ranges::find(points.cloud.positions, place) == points.cloud.positions.end());
    CHECK(points.cloud.normals == points.cloud.positions);
}

TEST_CASE(".om of the first versions, with lists of corners, is read", "[mesh_io]") {
    std::string bytes = "OMP\x22";
    for (const std::uint32_t count : {4u, 2u, 5u}) bytes += bytes_of(count);
    bytes += bytes_of(std::uint16_t(1 << 9 | 1 << 10 | 2 << 11)); // positions of vertices, floats
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) bytes += bytes_of(x);
    bytes += bytes_of(std::uint16_t(2 << 2 | 7 << 5)); // corners of faces, bytes
    for (const std::uint8_t corner : std::initializer_list<std::uint8_t>{0, 1, 2, 0, 2, 3}) {
        if (corner == 0) bytes += bytes_of(std::uint16_t(3)); // how many there are
        bytes += bytes_of(corner);
    }
    const PolygonMesh mesh = read_mesh(TempFile("a.om", bytes).path());
    CHECK(mesh.positions[2] == Vec3(1, 1, 0));
    CHECK(mesh.corners == std::vector<Index>{0, 1, 2, 0, 2, 3});
    CHECK_THROWS_WITH(read_mesh(TempFile("b.om", bytes.substr(0, bytes.size() - 1)).path()),
                      Catch::Matchers::Contains("ends early"));
}

TEST_CASE("a damaged .om is refused or read, never beyond its bytes and never without end", "[mesh_io]") {
    const TempFile whole("a.om", "");
    write_om(whole.path(), to_mesh(support::divided_cube(1)).mesh);
    const std::string content = support::read_file(whole.path());
    const auto read = [](const std::string& damaged) {
        auto bytes = std::make_unique<char[]>(damaged.size());
        damaged.copy(bytes.get(), damaged.size());
        try {
            const PolygonMesh mesh =
                io::read_mesh(io::SourceBytes::of(std::move(bytes), damaged.size(), "b.om"));
            CHECK(to_mesh(mesh).mesh.n_faces() <= 6);
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    REQUIRE(read(content).empty());
    for (std::size_t size = 0; size + 2 < content.size(); size += 7)
        CHECK_FALSE(read(content.substr(0, size)).empty());
    for (std::size_t at = 0; at < content.size(); ++at)
        for (const char value : {'\0', '\1', '\x7f', '\xff'}) {
            INFO("byte " << at << " is " << int(value));
            std::string damaged = content;
            damaged[at] = value;
            read(damaged);
        }
}
