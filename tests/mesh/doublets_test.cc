#include "hsdm/mesh/doublets.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// A cube whose top is two facets round a vertex 8 that no other has, `height` above it.
PolygonMesh cube_with_doublet(double height) {
    PolygonMesh mesh = support::mesh_of(
        support::cube_corners(),
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 8}, {8, 7, 6, 4}});
    mesh.positions.emplace_back(0.5, 0.5, 1 + height);
    return mesh;
}

const auto never = [](Index) { return false; };

} // namespace

TEST_CASE("the two facets round an expendable vertex become one", "[mesh]") {
    PolygonMesh mesh = cube_with_doublet(0.05);
    CHECK(merge_doublets(mesh, never) == 0);
    CHECK(merge_doublets(mesh, [](Index v) { return v == 8; }) == 1);
    CHECK(mesh.facet_count() == 6);
    CHECK(remove_isolated_vertices(mesh) == 1);
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK(t.quads == 6);
    CHECK(t.euler == 2);
}

TEST_CASE("a vertex on the straight way between its only two neighbours goes, its facets stay", "[mesh]") {
    PolygonMesh mesh = cube_with_doublet(0); // vertex 8 lies on the diagonal of the top
    PolygonMesh bent = cube_with_doublet(0.05);
    CHECK(drop_straight_vertices(0.04, bent) == 0);
    CHECK(drop_straight_vertices(0.06, bent) == 1);
    CHECK(drop_straight_vertices(0, mesh) == 1);
    CHECK(remove_isolated_vertices(mesh) == 1);
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK(t.triangles == 2);
    CHECK(t.quads == 5);
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
}

TEST_CASE("of two straight vertices between the same two neighbours none goes", "[mesh]") {
    // a pillow of two halves: a quad 4 8 7 9 on the diagonal of the top, both 8 and 9 between 4 and 7
    PolygonMesh mesh = support::mesh_of(support::cube_corners(), {{0, 2, 3, 1},
                                                                  {0, 1, 5, 4},
                                                                  {1, 3, 7, 5},
                                                                  {3, 2, 6, 7},
                                                                  {2, 0, 4, 6},
                                                                  {4, 5, 7, 8},
                                                                  {4, 8, 7, 9},
                                                                  {9, 7, 6, 4}});
    mesh.positions.emplace_back(0.51, 0.49, 1);
    mesh.positions.emplace_back(0.49, 0.51, 1);
    REQUIRE(measure_topology(mesh).closed());
    CHECK(drop_straight_vertices(0.1, mesh) == 0);
    CHECK(measure_topology(mesh).manifold());
}

TEST_CASE("of two straight vertices that are next to each other none goes", "[mesh]") {
    PolygonMesh mesh = cube_with_doublet(0);
    mesh.positions[8] = Vec3(0.3, 0.3, 1);
    mesh.positions.emplace_back(0.6, 0.6, 1);
    mesh.first[7] = mesh.first[6] = mesh.first[5];
    mesh.first.resize(6);
    mesh.corners.resize(mesh.first.back());
    mesh.add_facet(std::array<Index, 5>{4, 5, 7, 9, 8});
    mesh.add_facet(std::array<Index, 5>{8, 9, 7, 6, 4});
    REQUIRE(measure_topology(mesh).closed());
    CHECK(drop_straight_vertices(0.1, mesh) == 0);
    CHECK(measure_topology(mesh).manifold());
}

TEST_CASE("no vertex goes where an edge joins its neighbours", "[mesh]") {
    // a triangle 4 5 8 and the rest of the top: vertex 8 lies between 4 and 5, which have an edge already
    PolygonMesh mesh = support::mesh_of(
        support::cube_corners(),
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 8}, {8, 5, 7, 6, 4}});
    mesh.positions.emplace_back(0.5, 0, 1);
    const auto before = mesh.corners;
    CHECK(drop_straight_vertices(0.1, mesh) == 0);
    CHECK(mesh.corners == before);
}

TEST_CASE("facets folded onto each other become one whoever the vertex between them is", "[mesh]") {
    PolygonMesh mesh = cube_with_doublet(0);
    mesh.positions[8] = Vec3(0.5, 0.5, 3); // a sharp roof over the diagonal: its two sides face apart
    CHECK(merge_doublets(mesh, never) == 1);
    CHECK(measure_topology(mesh).closed());
}

TEST_CASE("a flap goes with all the vertices between its two facets", "[mesh]") {
    // The top of a cube reaches out to vertices 8 and 9, and a facet lies folded back under it there.
    PolygonMesh mesh = support::mesh_of(support::cube_corners(), {{0, 2, 3, 1},
                                                                  {0, 1, 5, 4},
                                                                  {1, 3, 7, 5},
                                                                  {3, 2, 6, 7},
                                                                  {2, 0, 4, 6},
                                                                  {4, 5, 9, 8, 7, 6},
                                                                  {5, 7, 8, 9}});
    mesh.positions.emplace_back(1.4, 0.8, 1);
    mesh.positions.emplace_back(1.4, 0.2, 1);
    REQUIRE(measure_topology(mesh).euler == 2);
    CHECK(merge_doublets(mesh, never) == 1);
    CHECK(remove_isolated_vertices(mesh) == 2);
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK(t.quads == 6);
    CHECK(t.euler == 2);
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
}

TEST_CASE("a doublet that a merger leaves is merged as well", "[mesh]") {
    PolygonMesh mesh = support::mesh_of(support::cube_corners(), {{0, 2, 3, 1},
                                                                  {0, 1, 5, 4},
                                                                  {1, 3, 7, 5},
                                                                  {3, 2, 6, 7},
                                                                  {2, 0, 4, 6},
                                                                  {4, 5, 9},
                                                                  {5, 7, 8, 9},
                                                                  {9, 8, 7, 6, 4}});
    mesh.positions.emplace_back(0.6, 0.6, 1);
    mesh.positions.emplace_back(0.3, 0.3, 1); // has two facets once those round 8 are one
    REQUIRE(measure_topology(mesh).closed());
    CHECK(merge_doublets(mesh, [](Index v) { return v >= 8; }) == 2);
    CHECK(remove_isolated_vertices(mesh) == 2);
    CHECK(measure_topology(mesh).quads == 6);
    CHECK(measure_topology(mesh).euler == 2);
}

TEST_CASE("a doublet whose union repeats a vertex is left alone", "[mesh]") {
    PolygonMesh mesh; // a bubble of two triangles: their union would be an edge
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    mesh.add_facet(std::array<Index, 3>{2, 1, 0});
    CHECK(merge_doublets(mesh, [](Index) { return true; }) == 0);
    PolygonMesh open = cube_with_doublet(0.05);
    open.first.pop_back();
    open.corners.resize(open.first.back());
    CHECK(merge_doublets(open, [](Index) { return true; }) == 0);
}
