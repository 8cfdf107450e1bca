#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
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

TEST_CASE("the facets at a cube's corners are the three that meet there", "[mesh]") {
    const PolygonMesh cube = support::unit_cube();
    std::vector<std::uint8_t> wanted(8, 0);
    wanted[2] = wanted[3] = 1;
    const FacetsAt at(cube, wanted);
    for (Index v = 0; v < 8; ++v) {
        CHECK(at.of(v).size() == (wanted[v] != 0 ? 3u : 0u));
        for (const Index f : at.of(v)) CHECK(std::ranges::count(cube.facet(f), v) == 1);
        CHECK(std::is_sorted(at.of(v).begin(), at.of(v).end()));
    }
    const std::vector<Index> any = at.of_any(std::array<Index, 3>{2, 3, 4});
    CHECK(any == at.all()); // none is known at 4
    CHECK(std::is_sorted(any.begin(), any.end()));
    CHECK(std::ranges::adjacent_find(any) == any.end());
}

TEST_CASE("the border of facets is one ring the way they run, or none", "[mesh]") {
    const PolygonMesh sheet = support::quad_sheet(3, 3, [](Index c, Index r) { return Vec3(c, r, 0); });
    const std::vector<Index> ring = border_of(sheet, {0, 1, 3}); // of an L
    REQUIRE(ring.size() == 8);
    CHECK(ring.front() == std::ranges::min(ring));
    double area = 0; // twice
    for (std::size_t i = 0; i < ring.size(); ++i)
        area += (sheet.positions[ring[i]] % sheet.positions[ring[(i + 1) % ring.size()]])[2];
    CHECK(std::abs(area) == Approx(6));
    CHECK(area * area_vector(sheet, sheet.facet(0))[2] > 0);
    CHECK(border_of(sheet, {0, 4}).empty());                            // meet in a vertex
    CHECK(border_of(sheet, {0, 2}).empty());                            // two rings
    CHECK(border_of(sheet, {0, 1, 2, 3, 5, 6, 7, 8}).empty());          // a ring round a hole
    CHECK(border_of(support::unit_cube(), {0, 1, 2, 3, 4, 5}).empty()); // closed
    CHECK(border_of(sheet, {}).empty());
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
