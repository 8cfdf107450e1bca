#include "hsdm/mesh/straight_corners.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;
using support::mesh_of;

namespace {

constexpr double least_sine = 0.1;

} // namespace

TEST_CASE("a quad with a straight or reflex corner becomes the two triangles there", "[straight]") {
    for (double height : {0.0, 0.2, -0.04}) { // straight, reflex, nearly straight
        PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, height, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}});
        CHECK(cut_straight_corners(mesh, least_sine) == 1);
        CHECK(mesh.corners == std::vector<Index>{1, 2, 3, 1, 3, 0});
        CHECK(cut_straight_corners(mesh, least_sine) == 0);
    }
}

TEST_CASE("with a least sine below zero reflex corners alone are cut", "[straight]") {
    const auto cuts = [](double height) {
        PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, height, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}});
        return cut_straight_corners(mesh, -0.01);
    };
    CHECK(cuts(0) == 0);     // straight
    CHECK(cuts(-0.04) == 0); // convex
    CHECK(cuts(0.004) == 0); // reflex by less
    CHECK(cuts(0.02) == 1);
    CHECK(cuts(0.2) == 1);
}

TEST_CASE("quads of which rounding decides are cut at their straight corner", "[straight]") {
    const auto cuts = [](double height, double tip) {
        PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, height, 0}, {2, 0, 0}, {1, tip, 0}}, {{0, 1, 2, 3}});
        const std::size_t count = cut_doubtful_quads(mesh);
        if (count > 0) CHECK(mesh.corners == std::vector<Index>{1, 2, 3, 1, 3, 0});
        CHECK(cut_doubtful_quads(mesh) == 0);
        return count;
    };
    for (const double height : {0.0, 1e-9, -1e-9}) {
        CHECK(cuts(height, 3) == 1);
        CHECK(cuts(height, 2) == 1); // both diagonals as long
        CHECK(cuts(height, 1) == 0); // cut at that corner anyway
    }
    CHECK(cuts(0.01, 3) == 0);
    CHECK(cuts(-0.01, 3) == 0);
}

TEST_CASE("many cuts are those made one by one", "[straight]") {
    // A strip of quads, each with a reflex corner, and the same strip turned over: pairs of the same
    // diagonal.
    PolygonMesh mesh;
    constexpr Index quads = 1000;
    for (Index q = 0; q < quads; ++q)
        for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0.2, 0), Vec3(2, 0, 0), Vec3(1, 1, 0)})
            mesh.positions.push_back(p + Vec3(3.0 * q, 0, 0));
    for (Index q = quads; q-- > 0;)
        mesh.add_facet(std::array<Index, 4>{4 * q, 4 * q + 1, 4 * q + 2, 4 * q + 3});
    for (Index q = 0; q < quads; ++q)
        mesh.add_facet(std::array<Index, 4>{4 * q + 3, 4 * q + 2, 4 * q + 1, 4 * q});
    CHECK(cut_straight_corners(mesh, -0.01) == quads);
    REQUIRE(mesh.facet_count() == 3 * quads);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        CHECK(mesh.facet(f).size() == (f < 2 * quads ? 3 : 4));
    CHECK(mesh.facet(0)[0] == 4 * (quads - 1) + 1);
}

TEST_CASE("convex quads, sharp corners and other polygons stay", "[straight]") {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
    PolygonMesh square = mesh_of(positions, {{0, 1, 2, 3}});
    CHECK(cut_straight_corners(square, least_sine) == 0);
    PolygonMesh needle = mesh_of({{0, 0, 0}, {1, -0.2, 0}, {9, 0, 0}, {1, 0.2, 0}}, {{0, 1, 2, 3}});
    CHECK(cut_straight_corners(needle, least_sine) == 0);
    PolygonMesh pentagon = mesh_of(positions, {{0, 1, 4, 2, 3}});
    CHECK(cut_straight_corners(pentagon, least_sine) == 0);
    CHECK(pentagon.facet_count() == 1);
}

TEST_CASE("no edge gets a third facet from a cut", "[straight]") {
    // The diagonal 1-3 is an edge of the two triangles already.
    PolygonMesh taken = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0.5, 1}, {1, 0.5, -1}},
                                {{0, 1, 2, 3}, {1, 3, 4}, {3, 1, 5}});
    CHECK(cut_straight_corners(taken, least_sine) == 0);
    // Back to back two such quads would both take it.
    PolygonMesh twice = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}, {3, 2, 1, 0}});
    CHECK(cut_straight_corners(twice, least_sine) == 1);
}
