#include "hsdm/facets/straight_corners.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

PolygonMesh mesh_of(const std::vector<Vec3>& positions, const std::vector<std::vector<Index>>& facets) {
    PolygonMesh mesh;
    mesh.positions = positions;
    for (const auto& facet : facets) mesh.add_facet(facet);
    return mesh;
}

} // namespace

TEST_CASE("a quad with a straight or reflex corner becomes the two triangles there", "[straight]") {
    for (double height : {0.0, 0.2, -0.04}) { // straight, reflex, nearly straight
        PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, height, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}});
        CHECK(cut_straight_corners(mesh) == 1);
        CHECK(mesh.corners == std::vector<Index>{1, 2, 3, 1, 3, 0});
        CHECK(cut_straight_corners(mesh) == 0);
    }
}

TEST_CASE("convex quads, sharp corners and other polygons stay", "[straight]") {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
    PolygonMesh square = mesh_of(positions, {{0, 1, 2, 3}});
    CHECK(cut_straight_corners(square) == 0);
    PolygonMesh needle = mesh_of({{0, 0, 0}, {1, -0.2, 0}, {9, 0, 0}, {1, 0.2, 0}}, {{0, 1, 2, 3}});
    CHECK(cut_straight_corners(needle) == 0);
    PolygonMesh pentagon = mesh_of(positions, {{0, 1, 4, 2, 3}});
    CHECK(cut_straight_corners(pentagon) == 0);
    CHECK(pentagon.facet_count() == 1);
}

TEST_CASE("no edge gets a third facet from a cut", "[straight]") {
    // The diagonal 1-3 is an edge of the two triangles already.
    PolygonMesh taken = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0.5, 1}, {1, 0.5, -1}},
                                {{0, 1, 2, 3}, {1, 3, 4}, {3, 1, 5}});
    CHECK(cut_straight_corners(taken) == 0);
    // Back to back two such quads would both take it.
    PolygonMesh twice = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}, {3, 2, 1, 0}});
    CHECK(cut_straight_corners(twice) == 1);
}
