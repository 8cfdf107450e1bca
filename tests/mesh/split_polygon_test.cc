#include "hsdm/mesh/split_polygon.hh"
#include "hsdm/quality/topology.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>

using namespace hsdm;

namespace {

PolygonMesh regular_polygon(Index n) {
    PolygonMesh mesh;
    std::vector<Index> facet;
    for (Index i = 0; i < n; ++i) {
        mesh.positions.emplace_back(std::cos(2 * std::numbers::pi * i / n),
                                    std::sin(2 * std::numbers::pi * i / n), 0);
        facet.push_back(i);
    }
    mesh.add_facet(facet);
    return mesh;
}

/// A prism over a regular polygon, outward.
PolygonMesh prism(Index n) {
    PolygonMesh mesh;
    for (double z : {0.0, 1.0})
        for (const Vec3& p : regular_polygon(n).positions) mesh.positions.push_back(p + Vec3(0, 0, z));
    std::vector<Index> bottom, top;
    for (Index i = 0; i < n; ++i) {
        bottom.push_back(n - 1 - i);
        top.push_back(n + i);
        mesh.add_facet(std::array{i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    mesh.add_facet(bottom);
    mesh.add_facet(top);
    return mesh;
}

} // namespace

TEST_CASE("a hexagon becomes two quads and a pentagon a quad and a triangle", "[split]") {
    PolygonMesh hexagon = regular_polygon(6);
    CHECK(split_large_facets(hexagon) == 1);
    CHECK(measure_topology(hexagon).quads == 2);
    PolygonMesh pentagon = regular_polygon(5);
    CHECK(split_large_facets(pentagon) == 1);
    CHECK(measure_topology(pentagon).quads == 1);
    CHECK(measure_topology(pentagon).triangles == 1);
}

TEST_CASE("quads and triangles are left alone", "[split]") {
    PolygonMesh quad = regular_polygon(4);
    const auto corners = quad.corners;
    CHECK(split_large_facets(quad) == 0);
    CHECK(quad.corners == corners);
}

TEST_CASE("a closed surface stays closed and keeps its volume", "[split]") {
    for (Index n : {5u, 6u, 7u, 12u, 200u}) {
        PolygonMesh mesh = prism(n);
        const double volume = measure_topology(mesh).signed_volume;
        CHECK(split_large_facets(mesh) == 2);
        const Topology topology = measure_topology(mesh);
        CHECK(topology.closed());
        CHECK(topology.manifold());
        CHECK(topology.larger == 0);
        CHECK(topology.euler == 2);
        CHECK(topology.signed_volume == Approx(volume));
    }
}

TEST_CASE("two polygons that share two corners do not take the same diagonal", "[split]") {
    // Two pentagons over the corners 0, 1, 2 and two more each, glued along 0-1-2: both want diagonal 0-2.
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0.05, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {2, -1, 0}, {0, -1, 0}};
    mesh.add_facet(std::vector<Index>{0, 1, 2, 3, 4});
    mesh.add_facet(std::vector<Index>{2, 1, 0, 6, 5});
    split_large_facets(mesh);
    const Topology topology = measure_topology(mesh);
    CHECK(topology.manifold());
    CHECK(topology.misoriented_edges == 0);
    CHECK(topology.duplicate_facets == 0);
}

TEST_CASE("a diagonal that is an edge already is avoided, and a polygon without another stays", "[split]") {
    PolygonMesh mesh = regular_polygon(5);
    for (Index i = 0; i < 5; ++i) { // a triangle beyond every diagonal
        mesh.positions.push_back(mesh.positions[i] + Vec3(0, 0, 1));
        mesh.add_facet(std::array{i, (i + 2) % 5, 5 + i});
    }
    CHECK(split_large_facets(mesh) == 0);
    CHECK(mesh.facet(0).size() == 5);
}
