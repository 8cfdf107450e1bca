#include "hsdm/mesh/edge_set.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// Two quads side by side:  3 4 5
///                          0 1 2
PolygonMesh two_quads() {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    mesh.add_facet(std::array<Index, 4>{0, 1, 4, 3});
    mesh.add_facet(std::array<Index, 4>{1, 2, 5, 4});
    return mesh;
}

} // namespace

TEST_CASE("a set of edges holds those between its vertices, from either end", "[mesh]") {
    const EdgeSet edges(two_quads(), std::array<Index, 4>{0, 1, 3, 4});
    for (const auto& [a, b] : {std::pair<Index, Index>{0, 1}, {1, 4}, {4, 3}, {3, 0}}) {
        CHECK(edges.contains(a, b));
        CHECK(edges.contains(b, a));
    }
    CHECK_FALSE(edges.contains(0, 4)); // a diagonal
    CHECK_FALSE(edges.contains(3, 1));
    CHECK_FALSE(edges.contains(1, 2)); // ends outside
    CHECK_FALSE(edges.contains(4, 5));
}

TEST_CASE("of a new facet a set takes the edges that several polygons might lay", "[mesh]") {
    const std::array<Index, 7> vertices{0, 1, 2, 0, 4, 2, 5}; // 0 and 2 belong to two polygons
    EdgeSet edges(two_quads(), vertices);
    CHECK_FALSE(edges.contains(0, 2));
    edges.add(std::array<Index, 3>{2, 0, 4});
    CHECK(edges.contains(0, 2));
    CHECK(edges.contains(2, 0));
    CHECK_FALSE(edges.contains(0, 4)); // 4 belongs to one
    CHECK_FALSE(edges.contains(4, 2));
}

TEST_CASE("a facet's last side counts as its others do", "[mesh]") {
    const std::array<Index, 6> twice{0, 4, 5, 0, 4, 5};
    EdgeSet edges(two_quads(), twice);
    CHECK(edges.contains(4, 5));                 // the last side of a facet too is an edge
    edges.add(std::array<Index, 4>{0, 6, 4, 5}); // 6 came after the set
    CHECK(edges.contains(5, 0));
    CHECK_FALSE(edges.contains(0, 6));
    CHECK_FALSE(edges.contains(6, 4));
    CHECK_FALSE(edges.contains(0, 4));
}
