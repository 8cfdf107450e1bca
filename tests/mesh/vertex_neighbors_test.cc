#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

TEST_CASE("the neighbours of a cube's corners are those along its edges", "[mesh]") {
    const PolygonMesh cube = support::unit_cube();
    const VertexNeighbors all(cube);
    for (Index v = 0; v < 8; ++v) {
        REQUIRE(all.of(v).size() == 3);
        CHECK(std::is_sorted(all.of(v).begin(), all.of(v).end()));
        for (const Index k : all.of(v)) CHECK((cube.positions[v] - cube.positions[k]).norm() == 1);
    }
    std::vector<std::uint8_t> wanted(8, 0);
    wanted[5] = 1;
    const VertexNeighbors one(cube, wanted);
    for (Index v = 0; v < 8; ++v) CHECK(one.of(v).size() == (v == 5 ? 3u : 0u));
}

TEST_CASE("a mesh that is turned over encloses the opposite volume, and its vertices face inward", "[mesh]") {
    PolygonMesh cube = support::unit_cube();
    for (const Vec3& p : vertex_area_vectors(cube)) CHECK(p.norm() == Approx(2 * std::sqrt(3)));
    turn_over(cube);
    CHECK(signed_volume(cube) == Approx(-1));
    const std::vector<Vec3> areas = vertex_area_vectors(cube);
    for (std::size_t v = 0; v < 8; ++v) CHECK((areas[v] | (cube.positions[v] - Vec3(0.5, 0.5, 0.5))) < 0);
}

TEST_CASE("a loop's length and the places along it", "[mesh]") {
    const PolygonMesh sheet = support::quad_sheet(3, 2, [](Index c, Index r) { return Vec3(c, 0.5 * r, 0); });
    const BoundaryLoops loops = boundary_loops(sheet);
    REQUIRE(loops.size() == 1);
    CHECK(length_of(sheet, loops[0]) == Approx(8));
    std::size_t places = 0;
    Box box;
    for_each_sample(sheet, loops, 0.25, [&](const Vec3& p) {
        ++places;
        box.add(p);
        CHECK((p[0] == 0 || p[0] == 3 || p[1] == 0 || p[1] == 1));
    });
    CHECK(places == 6 * 5 + 4 * 3);
    CHECK(box.size() == Vec3(3, 1, 0));
}
