#include "hsdm/errors.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <set>

#include <sys/stat.h>
#include <unistd.h>

using namespace hsdm;
using support::Folder;
using support::read_file;
namespace fs = std::filesystem;

namespace {

/// Triangles, quads and a pentagon over vertices whose doubles need every digit they have.
PolygonMesh sample(const Vec3& shift = {0, 0, 0}) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    PolygonMesh mesh;
    for (int i = 0; i < 5000; ++i) {
        mesh.positions.push_back(shift + Vec3(unit(random), unit(random), 1e-9 * unit(random)));
        mesh.normals.push_back(Vec3(unit(random), 0.1 + 0.2, 5e-324));
    }
    for (Index v = 0; v + 5 < 5000; v += 3) {
        const std::array<Index, 5> ring{v, v + 1, v + 2, v + 3, v + 4};
        mesh.add_facet({ring.data(), 3 + v % 9 / 3});
    }
    std::vector<double> level(5000), weight(5000), count(5000), exact(5000);
    for (std::size_t v = 0; v < 5000; ++v) {
        level[v] = static_cast<double>(v % 256);
        count[v] = -static_cast<double>(v);
        weight[v] = static_cast<double>(static_cast<float>(unit(random)));
        exact[v] = unit(random);
    }
    mesh.properties = {{"hsdm_level", VertexProperty::Type::uint8, level},
                       {"count", VertexProperty::Type::int32, count},
                       {"weight", VertexProperty::Type::float32, weight},
                       {"exact", VertexProperty::Type::float64, exact}};
    return mesh;
}

PolygonMesh square() {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    return mesh;
}

/// The message of the error when the text is read as a file of that name.
std::string complaint(const std::string& name, const std::string& text) {
    const Folder folder;
    folder.write(name, text);
    try {
        read_mesh(folder / name);
    } catch (const Error& error) {
        const std::string what = error.what();
        const std::string prefix = folder.path() + "/";
        return what.starts_with(prefix) ? what.substr(prefix.size()) : what;
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("OFF, OBJ and PLY give back the same bits and the same polygons", "[mesh_io]") {
    const Folder folder;
    const PolygonMesh mesh = sample(Vec3(1e7, -3e6, 0));
    for (const auto& [name, ascii] : {std::pair<std::string, bool>{"m.off", false},
                                      {"m.obj", false},
                                      {"m.ply", false},
                                      {"a.ply", true}}) {
        write_mesh(folder / name, mesh, mesh_format(name), {ascii});
        const PolygonMesh back = read_mesh(folder / name);
        INFO(name);
        CHECK((back.positions == mesh.positions));
        CHECK((back.corners == mesh.corners));
        CHECK((back.first == mesh.first));
        if (name == "m.off") continue;
        CHECK((back.normals == mesh.normals));
        if (name == "m.obj") continue;
        REQUIRE(back.properties.size() == mesh.properties.size());
        for (std::size_t i = 0; i < mesh.properties.size(); ++i) {
            CHECK(back.properties[i].name == mesh.properties[i].name);
            CHECK(back.properties[i].type == mesh.properties[i].type);
            CHECK((back.properties[i].values == mesh.properties[i].values));
        }
    }
    CHECK(folder.names().size() == 4); // no temporary file is left
}

TEST_CASE("STL keeps every polygon as triangles, welded again on reading", "[mesh_io]") {
    const Folder folder;
    const PolygonMesh mesh = square();
    for (const bool ascii : {false, true}) {
        write_mesh(folder / "s.stl", mesh, MeshFormat::stl, {ascii});
        CHECK(read_file(folder / "s.stl").starts_with("solid") == ascii);
        const Topology t = measure_topology(read_mesh(folder / "s.stl"));
        CHECK(t.triangles == 2);
        CHECK(t.vertices == 4);
        CHECK(t.boundary_edges == 4);
    }
    write_mesh(folder / "b.stl", mesh, MeshFormat::stl);
    CHECK(fs::file_size(folder / "b.stl") == 84 + 2 * 50);
}

TEST_CASE("STL becomes text where floats would move vertices", "[mesh_io]") {
    const Folder folder;
    PolygonMesh mesh = square();
    for (Vec3& p : mesh.positions) p = p * 0.1 + Vec3(1e6, 0, 0);
    CHECK(write_mesh(folder / "far.stl", mesh, MeshFormat::stl).text_for_precision);
    CHECK_FALSE(write_mesh(folder / "far.stl", mesh, MeshFormat::stl, {true}).text_for_precision);
    CHECK(read_file(folder / "far.stl").starts_with("solid"));
    CHECK(read_mesh(folder / "far.stl").positions[1] == mesh.positions[1]);
}

TEST_CASE("STL keeps meshes of any size, and the directions of their normals", "[mesh_io]") {
    const Folder folder;
    const double size = GENERATE(std::ldexp(1.0, -1000), std::ldexp(1.0, -500), std::ldexp(1.0, -100), 1e200,
                                 std::ldexp(1.0, 1023));
    PolygonMesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(size, 0, 0), Vec3(0, size, 0), Vec3(0, 0, size)};
    for (const auto& f : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) mesh.add_facet(f);
    write_mesh(folder / "t.stl", mesh, MeshFormat::stl);
    const PolygonMesh back = read_mesh(folder / "t.stl");
    CHECK(std::set(back.positions.begin(), back.positions.end())
          == std::set(mesh.positions.begin(), mesh.positions.end()));
    CHECK(back.facet_count() == 4);
    write_mesh(folder / "text.stl", mesh, MeshFormat::stl, {true});
    CHECK(read_file(folder / "text.stl").find("facet normal 0 0 -1\n") != std::string::npos);
}

TEST_CASE("an empty mesh is a valid file in every format", "[mesh_io]") {
    const Folder folder;
    for (const char* name : {"e.off", "e.ply", "e.stl", "e.obj"})
        CHECK_NOTHROW(write_mesh(folder / name, PolygonMesh{}, mesh_format(name)));
    CHECK(read_mesh(folder / "e.off").vertex_count() == 0);
    CHECK(read_mesh(folder / "e.ply").vertex_count() == 0);
}

TEST_CASE("facets of more than 255 corners survive", "[mesh_io]") {
    const Folder folder;
    PolygonMesh mesh;
    std::vector<Index> ring;
    for (Index v = 0; v < 1000; ++v) {
        mesh.positions.emplace_back(std::cos(v * 0.00628), std::sin(v * 0.00628), 0);
        ring.push_back(v);
    }
    mesh.add_facet(ring);
    for (const char* name : {"r.off", "r.ply", "r.obj"}) {
        write_mesh(folder / name, mesh, mesh_format(name));
        CHECK(read_mesh(folder / name).corners == ring);
    }
}

TEST_CASE("a write that fails leaves the old file, and no other", "[mesh_io]") {
    const Folder folder;
    PolygonMesh wrong = square();
    wrong.corners[2] = 99;
    for (const char* name : {"old.off", "old.stl", "old.ply", "old.obj"}) {
        folder.write(name, "old");
        CHECK_THROWS_AS(write_mesh(folder / name, wrong, mesh_format(name)), Error);
        CHECK(read_file(folder / name) == "old");
    }
    CHECK(folder.names().size() == 4);
    fs::create_directory(folder / "dir.off");
    CHECK_THROWS_WITH(write_mesh(folder / "dir.off", square(), MeshFormat::off), Catch::Contains("folder"));
    CHECK(folder.names().size() == 5);
    CHECK_THROWS_WITH(write_mesh(folder / "none/m.off", square(), MeshFormat::off),
                      Catch::Contains("No such file") && Catch::Contains("none/m.off: "));
}

TEST_CASE("a folder without permission is an error, not a crash", "[mesh_io]") {
    if (::geteuid() == 0) {
        WARN("skipped: root may write everywhere");
        return;
    }
    const Folder folder;
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    CHECK_THROWS_WITH(write_text(folder / "t.txt", "x"), Catch::Contains("Permission denied"));
}

TEST_CASE("a full disk is an error", "[mesh_io]") {
    if (!fs::exists("/dev/full")) {
        WARN("skipped: there is no /dev/full");
        return;
    }
    CHECK_THROWS_WITH(write_text("/dev/full", "x"), Catch::Contains("No space left"));
    CHECK(fs::is_character_file("/dev/full")); // written to, not replaced
}

TEST_CASE("a link is followed, and its target replaced", "[mesh_io]") {
    const Folder folder;
    folder.write("target.txt", "old");
    fs::create_symlink(folder / "target.txt", folder / "link.txt");
    write_text(folder / "link.txt", "new");
    CHECK(fs::is_symlink(folder / "link.txt"));
    CHECK(read_file(folder / "target.txt") == "new");
}

TEST_CASE("files have the permissions that the umask leaves", "[mesh_io]") {
    const Folder folder;
    const mode_t before = ::umask(027);
    write_text(folder / "t.txt", "x");
    ::umask(before);
    CHECK((fs::status(folder / "t.txt").permissions() & fs::perms::all) == static_cast<fs::perms>(0640));
}

TEST_CASE("a name of 255 bytes can be written", "[mesh_io]") {
    const Folder folder;
    const std::string name = std::string(251, 'n') + ".txt";
    write_text(folder / name, "x");
    CHECK(read_file(folder / name) == "x");
}

TEST_CASE("the extension names the format", "[mesh_io]") {
    CHECK(mesh_format("a/b.c/M.PLY") == MeshFormat::ply);
    CHECK(mesh_format("m.om") == MeshFormat::om);
    CHECK_THROWS_WITH(mesh_format("m.step"), Catch::Contains(".off"));
    CHECK_THROWS_AS(mesh_format("ply"), Error);
}

TEST_CASE("OBJ faces may count back, name textures and normals, and go over lines", "[mesh_io]") {
    const Folder folder;
    folder.write("m.obj",
                 "# a comment\r\nmtllib x.mtl\r\nv 0 0 0\r\nv 1 0 0 0.5\r\nv 1 1 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
                 "f 1/1/1 2/1/1 3/1/1\r\nf -3 \\\r\n -2 -1 # same\r\nl 1 2\r\nf 1//1 2//1 3//1\r\n");
    const PolygonMesh mesh = read_mesh(folder / "m.obj");
    CHECK(mesh.corners == std::vector<Index>{0, 1, 2, 0, 1, 2, 0, 1, 2});
    CHECK(mesh.normals.empty());
}

TEST_CASE("OFF files with counts beside the keyword, comments and colours are read", "[mesh_io]") {
    const Folder folder;
    folder.write(
        "m.off",
        "# made by hand\nCOFF 3 1 0 # counts\n\n0 0 0 255 0 0 255\n1 0 0 1 2 3 4\n# half way\n0 1 0 1 2 3 4\n"
        "3 0 1 2 0.5 0.5 0.5\n");
    const PolygonMesh mesh = read_mesh(folder / "m.off");
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.corners == std::vector<Index>{0, 1, 2});
}

TEST_CASE("PLY faces of any list types, among other elements, in either byte order", "[mesh_io]") {
    const Folder folder;
    std::string big =
        "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty list uchar short path\nelement vertex "
        "3\n"
        "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty uchar red\n"
        "property list ushort short vertex_index\nproperty list uchar float texcoord\nend_header\n";
    auto bytes = [&](std::initializer_list<int> b) {
        for (int x : b) big += static_cast<char>(x);
    };
    bytes({2, 0, 1, 0, 2});
    for (int v = 0; v < 3; ++v)
        for (int k = 0; k < 3; ++k)
            bytes({v == k ? 0x3f : 0, v == k ? 0x80 : 0, 0, 0}); // 1.0 on the diagonal
    bytes({7, 0, 3, 0, 2, 0, 1, 0, 0, 1, 0, 0, 0, 0});
    folder.write("b.ply", big);
    const PolygonMesh mesh = read_mesh(folder / "b.ply");
    CHECK(mesh.positions == std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK(mesh.corners == std::vector<Index>{2, 1, 0});
    CHECK(complaint("cut.ply", big.substr(0, big.size() - 7)).starts_with("cut.ply: "));
}

TEST_CASE("a file of points is a mesh without facets", "[mesh_io]") {
    const Folder folder;
    folder.write("p.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
                          "property double z\nend_header\n1 2 3\n");
    CHECK(read_mesh(folder / "p.ply").vertex_count() == 1);
    CHECK(read_mesh(folder / "p.ply").facet_count() == 0);
}

TEST_CASE("bad meshes are refused with the place and the reason", "[mesh_io]") {
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n"), "m.off:6: face 0"));
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 0\n1 1 0\n3 0 1 2\n"), "m.off:4: "));
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 x 0\n1 1 0\n3 0 1 2\n"), "m.off:4: \"x\""));
    CHECK(contains(complaint("m.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"), "1 of 2 faces"));
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 -1 2\n"), "m.off:6: "));
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1.5 2\n"), "whole number"));
    CHECK(contains(complaint("m.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n1 1 0\n3 0 1 2\n"), "not finite"));
    CHECK(contains(complaint("m.off", "OFF\n4000000000 1 0\n0 0 0\n"), "m.off:2: 4000000000"));
    CHECK(contains(complaint("m.off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0\n"), "m.off:4: "));
    CHECK(contains(complaint("m.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"), "m.obj:3: face 0"));
    CHECK(contains(complaint("m.obj", "v 0 0 0\nf 1 0 1\n"), "m.obj:2: "));
    CHECK(contains(complaint("m.obj", "v 0 0 0\nf -1 -2 -1\n"), "m.obj:2: "));
    CHECK(contains(complaint("m.obj", "v 0 0 0\nf 1 99999999999999999999 1\n"), "m.obj:2: "));
    CHECK(contains(complaint("m.obj", "hello\n"), "no vertices"));
    CHECK(contains(complaint("m.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"), "m.stl:"));
    CHECK(contains(complaint("m.stl", "short"), "m.stl: "));
    CHECK(contains(complaint("m.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                                      "property float y\nproperty float z\nend_header\n0 0 0\n"),
                   "too short"));
    CHECK(contains(complaint("m.ply",
                             "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0\n3 0 0 1\n"),
                   "m.ply:11: face 0"));
    CHECK(contains(complaint("m.ply", "OFF\n"), "m.ply"));
    CHECK(contains(complaint("m.xyz", "1 2 3\n"), "no mesh format"));
    CHECK(contains(complaint("m.off", ""), "empty"));
}

TEST_CASE("a mesh file cut anywhere gives an error or a mesh, never a crash", "[mesh_io]") {
    const Folder folder;
    PolygonMesh mesh = square();
    mesh.normals.assign(4, Vec3(0, 0, 1));
    for (const auto& [name, ascii] : {std::pair<std::string, bool>{"m.off", false},
                                      {"m.obj", false},
                                      {"m.ply", false},
                                      {"a.ply", true},
                                      {"m.stl", false},
                                      {"a.stl", true}}) {
        write_mesh(folder / name, mesh, mesh_format(name), {ascii});
        const std::string whole = read_file(folder / name);
        std::size_t meshes = 0;
        for (std::size_t size = 0; size < whole.size(); ++size) {
            folder.write("cut-" + name, whole.substr(0, size));
            try {
                meshes += read_mesh(folder / ("cut-" + name)).facet_count() > 2;
            } catch (const Error&) {
            }
        }
        CHECK(meshes == 0);
    }
}
