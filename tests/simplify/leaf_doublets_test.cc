#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/leaf_doublets.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

PolygonMesh cube_without_top() {
    return support::mesh_of(support::cube_corners(),
                            {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}});
}

} // namespace

TEST_CASE("two facets round one vertex become one", "[simplify]") {
    PolygonMesh mesh = cube_without_top();
    mesh.positions.emplace_back(0.5, 0.5, 1);
    mesh.add_facet(std::array<Index, 4>{4, 5, 7, 8});
    mesh.add_facet(std::array<Index, 4>{8, 7, 6, 4});
    const std::vector<Index> stands_for = dissolve_doublets(mesh);
    CHECK((stands_for[8] == 4 || stands_for[8] == 7));
    CHECK(stands_for[3] == 3);
    CHECK(remove_isolated_vertices(mesh) == 1);
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.quads == 6);
    CHECK(t.euler == 2);
}

TEST_CASE("a vertex between two facets stays where it is to", "[simplify]") {
    PolygonMesh mesh = cube_without_top();
    mesh.positions.emplace_back(0.5, 0.5, 1);
    mesh.add_facet(std::array<Index, 4>{4, 5, 7, 8});
    mesh.add_facet(std::array<Index, 4>{8, 7, 6, 4});
    std::vector<std::uint8_t> stays(9, 0);
    stays[8] = 1;
    CHECK(dissolve_doublets(mesh, stays)[8] == 8);
    CHECK(mesh.facet_count() == 7);
    stays[8] = 0;
    CHECK(dissolve_doublets(mesh, stays)[8] != 8);
    CHECK(mesh.facet_count() == 6);
}

TEST_CASE("a flap goes, and one vertex stands for those between its facets", "[simplify]") {
    PolygonMesh mesh = cube_without_top();
    mesh.positions.emplace_back(1.4, 0.8, 1); // the top reaches out to these, and a facet lies back under it
    mesh.positions.emplace_back(1.4, 0.2, 1);
    mesh.add_facet(std::array<Index, 6>{4, 5, 9, 8, 7, 6});
    mesh.add_facet(std::array<Index, 4>{5, 7, 8, 9});
    const std::vector<Index> stands_for = dissolve_doublets(mesh);
    CHECK(stands_for[8] == stands_for[9]);
    CHECK((stands_for[8] == 5 || stands_for[8] == 7));
    CHECK(remove_isolated_vertices(mesh) == 2);
    CHECK(measure_topology(mesh).quads == 6);
    CHECK(measure_topology(mesh).closed());
}

TEST_CASE("a vertex that a third facet has stays, though two share the sides round it", "[simplify]") {
    PolygonMesh mesh = cube_without_top();
    mesh.positions.emplace_back(1.4, 0.8, 1);
    mesh.positions.emplace_back(1.4, 0.2, 1);
    mesh.positions.emplace_back(2, 1, 1); // a bubble of two quads hangs on vertex 8
    mesh.positions.emplace_back(2, 1, 2);
    mesh.positions.emplace_back(2, 2, 1);
    mesh.add_facet(std::array<Index, 6>{4, 5, 9, 8, 7, 6});
    mesh.add_facet(std::array<Index, 4>{5, 7, 8, 9});
    mesh.add_facet(std::array<Index, 4>{8, 10, 11, 12});
    mesh.add_facet(std::array<Index, 4>{8, 12, 11, 10});
    const std::vector<Index> stands_for = dissolve_doublets(mesh);
    CHECK(stands_for[8] == 8);
    for (const Index v : mesh.corners) CHECK(stands_for[v] == v);
}

TEST_CASE("triangles back to back go, and the edge that they doubled is one again", "[simplify]") {
    PolygonMesh mesh = cube_without_top();
    mesh.positions.emplace_back(0.5, 0, 1); // a flap of two triangles beyond the edge 4, 5
    mesh.add_facet(std::array<Index, 4>{4, 5, 7, 6});
    mesh.add_facet(std::array<Index, 3>{4, 5, 8});
    mesh.add_facet(std::array<Index, 3>{8, 5, 4});
    REQUIRE_FALSE(measure_topology(mesh).manifold());
    const std::vector<Index> stands_for = dissolve_doublets(mesh);
    CHECK((stands_for[8] == 4 || stands_for[8] == 5));
    CHECK(remove_isolated_vertices(mesh) == 1);
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK(t.euler == 2);
}

TEST_CASE("a component of two facets stays, and so does a border", "[simplify]") {
    PolygonMesh bubble;
    bubble.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    bubble.add_facet(std::array<Index, 3>{0, 1, 2});
    bubble.add_facet(std::array<Index, 3>{2, 1, 0});
    dissolve_doublets(bubble);
    CHECK(bubble.facet_count() == 2);
    PolygonMesh open = cube_without_top(); // two facets at each vertex of the rim
    dissolve_doublets(open);
    CHECK(open.facet_count() == 5);
}
