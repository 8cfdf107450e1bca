#include "hsdm/simplify/nonmanifold_vertices.hh"

#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

void add(PolygonMesh& mesh, std::vector<Index> facet) {
    for (Index v : facet)
        while (mesh.vertex_count() <= v) {
            const auto n = static_cast<double>(mesh.vertex_count());
            mesh.positions.emplace_back(n, n * n, n * n * n); // no four in a plane
        }
    mesh.add_facet(facet);
}

} // namespace

TEST_CASE("no trouble in a tetrahedron or an open strip", "[simplify]") {
    PolygonMesh tetrahedron;
    add(tetrahedron, {0, 2, 1});
    add(tetrahedron, {0, 1, 3});
    add(tetrahedron, {1, 2, 3});
    add(tetrahedron, {2, 0, 3});
    CHECK(nonmanifold_vertices(tetrahedron).empty());
    PolygonMesh strip;
    add(strip, {0, 1, 3, 2});
    add(strip, {2, 3, 5, 4});
    CHECK(nonmanifold_vertices(strip).empty());
}

TEST_CASE("trouble is found where it is", "[simplify]") {
    PolygonMesh three_at_an_edge;
    add(three_at_an_edge, {0, 1, 2});
    add(three_at_an_edge, {1, 0, 3});
    add(three_at_an_edge, {0, 1, 4});
    CHECK(nonmanifold_vertices(three_at_an_edge) == std::vector<Index>{0, 1});
    PolygonMesh same_way;
    add(same_way, {0, 1, 2});
    add(same_way, {0, 1, 3});
    CHECK(nonmanifold_vertices(same_way) == std::vector<Index>{0, 1});
    PolygonMesh bow_tie;
    add(bow_tie, {0, 1, 2});
    add(bow_tie, {0, 3, 4});
    CHECK(nonmanifold_vertices(bow_tie) == std::vector<Index>{0});
    PolygonMesh flat;
    add(flat, {0, 1, 2});
    flat.positions[2] = 3 * flat.positions[1];
    CHECK(nonmanifold_vertices(flat) == std::vector<Index>{0, 1, 2});
    PolygonMesh back_to_back;
    add(back_to_back, {0, 1, 2});
    add(back_to_back, {2, 1, 0});
    CHECK(nonmanifold_vertices(back_to_back) == std::vector<Index>{0, 1, 2});
}

TEST_CASE("vertices of two facets are trouble unless they may be", "[simplify]") {
    PolygonMesh cube = support::mesh_of(
        support::cube_corners(),
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 8}, {8, 7, 6, 4}});
    cube.positions.emplace_back(0.5, 0.5, 1.1);
    std::vector<std::uint8_t> may(9, 0);
    CHECK(nonmanifold_vertices(cube) == std::vector<Index>{8});
    CHECK(nonmanifold_vertices(cube, may) == std::vector<Index>{8});
    may[8] = 1;
    CHECK(nonmanifold_vertices(cube, may).empty());
    cube.corners.back() = 5; // a facet turned: 5 in place of 4
    CHECK_FALSE(nonmanifold_vertices(cube, may).empty());
}

TEST_CASE("a side without length is trouble, whatever area its facet has", "[simplify]") {
    PolygonMesh strip;
    add(strip, {0, 1, 3, 2});
    add(strip, {2, 3, 5, 4});
    strip.positions[5] = strip.positions[3];
    CHECK(nonmanifold_vertices(strip) == std::vector<Index>{2, 3, 4, 5});
}
