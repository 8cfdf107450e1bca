#include "hsdm/io/float_precision.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace hsdm;
using support::Folder;
using support::read_file;

namespace {

PolygonMesh tetrahedron(const Vec3& shift, double size) {
    PolygonMesh mesh;
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        mesh.positions.push_back(shift + size * (p + Vec3(0.1, 0.2, 0.3)));
    for (const std::array<Index, 3>& t : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})
        mesh.add_facet(t);
    return mesh;
}

} // namespace

TEST_CASE("what floats move is told as a share of the diagonal, whatever the mesh's size", "[mesh_io]") {
    for (const double size : {1e-200, 1e-3, 1.0, 1e100}) {
        CAPTURE(size);
        const double near = moved_by_floats(tetrahedron({0, 0, 0}, size).positions);
        if (size > 1e-30 && size < 1e30) CHECK(near < 1e-7);
        if (size > 1e-30 && size < 1e30) CHECK(near > 0);
        if (size > 1e30) CHECK(std::isinf(near));
        if (size < 1e-30) CHECK(near > 0.1); // they become zero
    }
    CHECK(moved_by_floats(tetrahedron({1e7, 0, 0}, 1).positions) > 0.05);
    CHECK(moved_by_floats(std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)}) == 0);
}

TEST_CASE("a shift lies near the middle, is a round number, and gives the positions back when it is added",
          "[mesh_io]") {
    for (const double size : {0.003, 0.7, 1.0, 25.0, 4000.0})
        for (const Vec3& place : {Vec3(2.6e6, -1.2e6, 437.25), Vec3(1e7, 1e7, 1e7), Vec3(0, 123456, 0)}) {
            CAPTURE(size, place);
            const PolygonMesh mesh = tetrahedron(place, size);
            const Vec3 shift = recentring_shift(mesh.positions);
            for (const Vec3& p : mesh.positions) {
                CHECK((p - shift).norm() < 4 * size);
                for (unsigned k = 0; k < 3; ++k)
                    CHECK(std::abs((p[k] - shift[k]) + shift[k] - p[k]) <= 1e-9 * size);
            }
            if (size >= 1)
                for (unsigned k = 0; k < 3; ++k) CHECK(shift[k] == std::floor(shift[k]));
            std::vector<Vec3> moved;
            for (const Vec3& p : mesh.positions) moved.push_back(p - shift);
            CHECK(moved_by_floats(moved) <= most_moved_by_floats);
        }
    CHECK(recentring_shift(tetrahedron({0, 0, 0}, 1).positions) == Vec3(0, 0, 0));
    CHECK(recentring_shift(std::vector<Vec3>{Vec3(5, 5, 5)}) == Vec3(0, 0, 0));
}

TEST_CASE("a mesh far from the origin is binary STL in full precision once it is recentred", "[mesh_io]") {
    const Folder folder;
    const PolygonMesh mesh = tetrahedron({2.6e6, 1.2e6, 400}, 0.25);
    const WrittenMesh far = write_mesh(folder / "far.stl", mesh, MeshFormat::stl);
    CHECK(far.text_for_precision);
    CHECK(far.moved_by_floats > 0.1);
    CHECK(far.shift == Vec3(0, 0, 0));
    const WrittenMesh near = write_mesh(folder / "near.stl", mesh, MeshFormat::stl, {.recentre = true});
    CHECK(!near.text_for_precision);
    CHECK(near.moved_by_floats < most_moved_by_floats);
    REQUIRE(read_file(folder / "near.stl").size() == 84 + 4 * 50);
    const PolygonMesh read = read_mesh(folder / "near.stl");
    REQUIRE(read.facet_count() == 4);
    for (std::size_t f = 0; f < 4; ++f)
        for (std::size_t i = 0; i < 3; ++i)
            CHECK((read.positions[read.facet(f)[i]] + near.shift - mesh.positions[mesh.facet(f)[i]]).norm()
                  < 1e-7);
    for (const char* name : {"m.off", "m.ply", "m.obj", "m.om"}) {
        CAPTURE(name);
        CHECK(write_mesh(folder / name, mesh, mesh_format(name), {.recentre = true}).shift == near.shift);
        CHECK((read_mesh(folder / name).positions[0] + near.shift - mesh.positions[0]).norm() < 1e-9);
    }
}

TEST_CASE("every format has one name, and is found by it as an extension in either case", "[mesh_io]") {
    std::set<std::string_view> names;
    for (const MeshFormatInfo& info : mesh_formats()) {
        CHECK(names.insert(info.name).second);
        CHECK(mesh_format("a." + std::string(info.name)) == info.format);
        CHECK(info_of(info.format).title == info.title);
    }
    CHECK(mesh_format("A.GLB") == MeshFormat::glb);
    CHECK(mesh_format("a.3MF") == MeshFormat::mf3);
    CHECK_THROWS_WITH(mesh_format("a.gltf"),
                      Catch::EndsWith("use .off, .stl, .ply, .obj, .om, .glb or .3mf"));
}
