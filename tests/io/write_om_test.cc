#include "hsdm/io/write_mesh.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <OpenMesh/Core/IO/MeshIO.hh>

#include <filesystem>

#include <cstdlib>
#include <fstream>
#include <new>
#include <string>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace hsdm;

TEST_CASE(".om keeps doubles, polygons, the hsdm properties and the status bits", "[mesh_io]") {
    PolygonMesh polygons;
    polygons.positions = {
        {1e7 + 0.1, 0, 0}, {1e7 + 1, 1.0 / 3, 0}, {1e7 + 1, 1, 1e-9}, {1e7, 1, 0}, {1e7 + 2, 2, 2}};
    polygons.normals.assign(5, Vec3(0.6, 0, 0.8));
    polygons.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    polygons.add_facet(std::array<Index, 3>{1, 4, 2});
    PolyMesh mesh = to_mesh(polygons).mesh;
    {
        auto vertex_class = kept_vertex_property<std::uint8_t>(mesh, vertex_class_property);
        auto count = kept_vertex_property<std::uint8_t>(mesh, normal_count_property);
        auto normals = kept_vertex_property<VertexNormalsT<PolyMesh>>(mesh, vertex_normals_property);
        auto level = kept_vertex_property<std::uint8_t>(mesh, level_property);
        for (const auto v : mesh.vertices()) {
            vertex_class[v] = static_cast<std::uint8_t>(v.idx() % 3);
            count[v] = static_cast<std::uint8_t>(1 + v.idx() % 3);
            normals[v] = {Vec3(0, 0, 1), Vec3(0, 1.0 / 3, v.idx()), Vec3(1, 0, 0)};
            level[v] = 7;
        }
    }
    mesh.status(OpenMesh::VertexHandle(1)).set_feature(true);
    mesh.status(OpenMesh::EdgeHandle(2)).set_feature(true);

    const support::Folder folder;
    const std::string path = folder / "m.om";
    write_om(path, mesh);
    PolyMesh back;
    for (const char* name : {vertex_class_property, normal_count_property, level_property})
        kept_vertex_property<std::uint8_t>(back, name);
    kept_vertex_property<VertexNormalsT<PolyMesh>>(back, vertex_normals_property);
    OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexNormal;
    options += OpenMesh::IO::Options::Status;
    REQUIRE(OpenMesh::IO::read_mesh(back, path, options));

    REQUIRE(back.n_vertices() == mesh.n_vertices());
    REQUIRE(back.n_edges() == mesh.n_edges());
    const PolygonMesh there = to_polygons(mesh), again = to_polygons(back);
    CHECK(again.positions == there.positions);
    CHECK(again.normals == there.normals);
    CHECK(again.corners == there.corners);
    CHECK(again.first == there.first);
    OpenMesh::VProp<std::uint8_t> vertex_class(back, vertex_class_property), level(back, level_property);
    OpenMesh::VProp<VertexNormalsT<PolyMesh>> normals(back, vertex_normals_property);
    for (const auto v : back.vertices()) {
        CHECK(vertex_class[v] == v.idx() % 3);
        CHECK(level[v] == 7);
        CHECK(normals[v][1] == Vec3(0, 1.0 / 3, v.idx()));
        CHECK(back.status(v).feature() == (v.idx() == 1));
    }
    for (const auto e : back.edges()) CHECK(back.status(e).feature() == (e.idx() == 2));
}

TEST_CASE("write_mesh writes .om through a half-edge mesh", "[mesh_io]") {
    PolygonMesh polygons;
    polygons.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    polygons.add_facet(std::array<Index, 3>{0, 1, 2});
    const support::Folder folder;
    const std::string path = folder / "m.om";
    write_mesh(path, polygons, MeshFormat::om);
    PolyMesh back;
    CHECK(OpenMesh::IO::read_mesh(back, path));
    CHECK(back.n_faces() == 1);
    CHECK_THROWS(write_mesh("/nonexistent-folder/m.om", polygons, MeshFormat::om));
}

#if !defined(HSDM_SANITIZED) // whose shadow memory needs the address space
TEST_CASE(".om is written where no memory is left for the whole of it", "[mesh_io]") {
    PolygonMesh polygons;
    const std::size_t count = 100000; // 9 MB
    for (std::size_t i = 0; i < count; ++i) {
        polygons.positions.push_back({static_cast<double>(i), static_cast<double>(i % 2), 0});
        if (i > 1)
            polygons.add_facet(std::array<Index, 3>{Index(i - 2 + i % 2), Index(i - 1 - i % 2), Index(i)});
    }
    PolyMesh mesh = to_mesh(polygons).mesh;
    kept_vertex_property<VertexNormalsT<PolyMesh>>(mesh, vertex_normals_property);
    const support::Folder folder;
    const std::string path = folder / "m.om";
    const pid_t child = ::fork();
    if (child == 0) {
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t limit = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (1 << 20);
        const rlimit most{limit, limit};
        if (::setrlimit(RLIMIT_AS, &most) != 0) ::_exit(3);
        try {
            write_om(path, mesh);
            ::_exit(0);
        } catch (const std::bad_alloc&) {
            ::_exit(2);
        }
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    std::error_code ignored;
    CHECK(std::filesystem::file_size(path, ignored) > 9000000);
}
#endif
