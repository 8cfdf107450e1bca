#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using support::cube_corners;
using support::mesh_of;
using support::unit_cube;

namespace {

/// n x m quads; `wrap` glues the sides of the first, the second or both directions; `twist` glues the first
/// one the other way up.
PolygonMesh grid(Index n, Index m, bool wrap_n, bool wrap_m, bool twist = false) {
    const Index rows = wrap_n ? n : n + 1, columns = wrap_m ? m : m + 1;
    PolygonMesh mesh;
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < columns; ++j) mesh.positions.emplace_back(i, j, (i * 7 + j * 3) % 5);
    auto id = [&](Index i, Index j) {
        if (i >= rows && twist) j = columns - 1 - j;
        return (i % rows) * columns + j % columns;
    };
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < m; ++j)
            mesh.add_facet(std::array<Index, 4>{id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    return mesh;
}

} // namespace

TEST_CASE("a cube is one closed outward sphere", "[topology]") {
    const Topology t = measure_topology(unit_cube());
    CHECK(t.vertices == 8);
    CHECK(t.edges == 12);
    CHECK(t.faces == 6);
    CHECK(t.quads == 6);
    CHECK(t.components == 1);
    CHECK(t.euler == 2);
    CHECK(t.genus() == 0);
    CHECK(t.manifold());
    CHECK(t.closed());
    CHECK(t.misoriented_edges + t.degenerate_facets + t.duplicate_facets + t.isolated_vertices == 0);
    CHECK(t.signed_volume == Approx(1));
}

TEST_CASE("the volume of a mesh far from the origin keeps its digits", "[topology]") {
    PolygonMesh mesh = unit_cube();
    for (Vec3& p : mesh.positions) p = p * 0.001 + Vec3(1e6, 2e6, 3e6);
    CHECK(measure_topology(mesh).signed_volume == Approx(1e-9).epsilon(1e-5));
}

TEST_CASE("a cube turned inside out has a negative volume", "[topology]") {
    PolygonMesh mesh = unit_cube();
    for (std::size_t f = 0; f < 6; ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f], mesh.corners.begin() + mesh.first[f + 1]);
    const Topology t = measure_topology(mesh);
    CHECK(t.signed_volume == Approx(-1));
    CHECK(t.misoriented_edges == 0);
}

TEST_CASE("one facet turned over shows at its four edges", "[topology]") {
    PolygonMesh mesh = unit_cube();
    std::reverse(mesh.corners.begin(), mesh.corners.begin() + 4);
    CHECK(measure_topology(mesh).misoriented_edges == 4);
    CHECK(measure_topology(mesh).manifold());
}

TEST_CASE("grids glued along their sides have the genus and loops of plane, tube, torus, Moebius strip",
          "[topology]") {
    const Topology plane = measure_topology(grid(5, 4, false, false));
    CHECK(plane.boundary_loops == 1);
    CHECK(plane.boundary_edges == 18);
    CHECK(plane.genus() == 0);
    CHECK_FALSE(plane.closed());
    const Topology tube = measure_topology(grid(5, 4, true, false));
    CHECK(tube.boundary_loops == 2);
    CHECK(tube.genus() == 0);
    const Topology torus = measure_topology(grid(5, 4, true, true));
    CHECK(torus.boundary_loops == 0);
    CHECK(torus.closed());
    CHECK(torus.genus() == 1);
    const Topology moebius = measure_topology(grid(5, 4, true, false, true));
    CHECK(moebius.boundary_loops == 1);
    CHECK(moebius.euler == 0);
    CHECK(moebius.misoriented_edges == 4); // no orientation exists, so some seam disagrees
    CHECK(moebius.manifold());
}

TEST_CASE("two triangles that share a corner make a bow tie", "[topology]") {
    const Topology t = measure_topology(
        mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
    CHECK(t.nonmanifold_vertices == 1);
    CHECK(t.nonmanifold_edges == 0);
    CHECK(t.components == 2);
    CHECK(t.boundary_loops == 2);
    CHECK_FALSE(t.manifold());
}

TEST_CASE("three facets at an edge make the edge and both its ends non-manifold", "[topology]") {
    const Topology t = measure_topology(mesh_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}},
                                                {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}));
    CHECK(t.nonmanifold_edges == 1);
    CHECK(t.nonmanifold_vertices == 2);
    CHECK(t.components == 1);
    CHECK(t.boundary_edges == 6);
}

TEST_CASE("a facet twice, in any rotation or direction, counts as one duplicate", "[topology]") {
    const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    CHECK(measure_topology(mesh_of(p, {{0, 1, 2, 3}, {2, 3, 0, 1}})).duplicate_facets == 1);
    CHECK(measure_topology(mesh_of(p, {{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 0, 2, 3}})).duplicate_facets == 2);
    CHECK(measure_topology(mesh_of(p, {{0, 1, 2}, {0, 1, 3}})).duplicate_facets == 0);
}

TEST_CASE("collapsed facets are counted and are no part of the surface", "[topology]") {
    PolygonMesh mesh = unit_cube();
    mesh.add_facet(std::array<Index, 3>{0, 0, 1});
    mesh.add_facet(std::array<Index, 4>{2, 3, 3, 2});
    mesh.add_facet(std::array<Index, 2>{4, 5});
    mesh.add_facet({});
    const Topology t = measure_topology(mesh);
    CHECK(t.degenerate_facets == 4);
    CHECK(t.faces == 10);
    CHECK(t.edges == 12);
    CHECK(t.euler == 2);
    CHECK(t.closed());
}

TEST_CASE("a facet without area is degenerate", "[topology]") {
    const Topology t =
        measure_topology(mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}));
    CHECK(t.degenerate_facets == 1);
}

TEST_CASE("isolated vertices are counted apart", "[topology]") {
    PolygonMesh mesh = unit_cube();
    mesh.positions.emplace_back(9, 9, 9);
    const Topology t = measure_topology(mesh);
    CHECK(t.vertices == 8);
    CHECK(t.isolated_vertices == 1);
    CHECK(t.euler == 2);
}

TEST_CASE("loops that touch in a vertex stay two loops where two fans meet", "[topology]") {
    // A 3 x 3 grid without two facets that touch at a corner: the hole's two loops share vertex 5.
    PolygonMesh full = grid(5, 5, false, false), mesh;
    mesh.positions = full.positions;
    for (std::size_t f = 0; f < full.facet_count(); ++f)
        if (f != 6 && f != 12) mesh.add_facet(full.facet(f));
    const Topology t = measure_topology(mesh);
    CHECK(t.nonmanifold_vertices == 1);
    CHECK(t.boundary_edges == 28);
}

TEST_CASE("an empty mesh has nothing of anything", "[topology]") {
    const Topology t = measure_topology(PolygonMesh{});
    CHECK(t.components + t.edges + t.boundary_loops + t.faces == 0);
    CHECK(t.manifold());
    CHECK_FALSE(t.closed());
    CHECK(measure_shape(PolygonMesh{}).quad_share == 0);
}

TEST_CASE("facet shape is 1 for squares and less for leaning and folded quads", "[topology]") {
    const FacetShape square = measure_shape(unit_cube());
    PolygonMesh many; // more facets than are measured at once
    constexpr Index wide = 600, high = 500;
    for (Index y = 0; y <= high; ++y)
        for (Index x = 0; x <= wide; ++x) many.positions.emplace_back(2.0 * x, 1.0 * y, 0);
    for (Index y = 0; y < high; ++y)
        for (Index x = 0; x < wide; ++x) {
            const Index v = y * (wide + 1) + x;
            many.add_facet(std::array{v, v + 1, v + wide + 2, v + wide + 1});
        }
    many.add_facet(std::array<Index, 3>{0, 1, wide + 1});
    const FacetShape of_many = measure_shape(many);
    CHECK(of_many.quad_share == 300000.0 / 300001);
    CHECK(of_many.scaled_jacobian_min == 1);
    CHECK(of_many.edge_length_mean == Approx(1.5).epsilon(1e-5));
    CHECK(square.quad_share == 1);
    CHECK(square.scaled_jacobian_min == Approx(1));
    CHECK(square.edge_length_mean == Approx(1));
    const FacetShape leaning = measure_shape(
        mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 1, 0}, {5, 5, 5}}, {{0, 1, 2, 3}, {0, 1, 4}}));
    CHECK(leaning.scaled_jacobian_median == Approx(std::sqrt(0.5)));
    CHECK(leaning.quad_share == 0.5);
    const FacetShape dart =
        measure_shape(mesh_of({{0, 0, 0}, {4, -1, 0}, {1, 0, 0}, {4, 1, 0}}, {{0, 1, 2, 3}}));
    CHECK(dart.scaled_jacobian_min < 0);
}
