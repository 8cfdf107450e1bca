#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace hsdm;

namespace {

/// The surface of n x n x n small cubes.
PolygonMesh grid_cube(int n) {
    PolygonMesh mesh;
    for (int i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i)
        mesh.positions.emplace_back(i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1));
    const auto at = [&](std::array<int, 3> c) {
        return static_cast<Index>(c[0] + (n + 1) * (c[1] + (n + 1) * c[2]));
    };
    for (unsigned axis = 0; axis < 3; ++axis)
        for (int side : {0, n})
            for (int u = 0; u < n; ++u)
                for (int v = 0; v < n; ++v) {
                    std::array<Index, 4> quad;
                    for (unsigned k = 0; k < 4; ++k) {
                        std::array<int, 3> c{};
                        c[axis] = side;
                        c[(axis + 1) % 3] = u + (k == 1 || k == 2);
                        c[(axis + 2) % 3] = v + (k >= 2);
                        quad[side > 0 ? k : 3 - k] = at(c);
                    }
                    mesh.add_facet(quad);
                }
    remove_isolated_vertices(mesh);
    return mesh;
}

std::ptrdiff_t collapse(PolygonMesh& mesh, std::span<const EdgeCollapse> edges) {
    return std::ranges::count(collapse_edges(mesh, edges), 1);
}

/// The first side of a facet, to its middle.
EdgeCollapse first_side(const PolygonMesh& mesh, std::size_t facet) {
    const Index a = mesh.facet(facet)[0], b = mesh.facet(facet)[1];
    return {a, b, 0.5 * (mesh.positions[a] + mesh.positions[b])};
}

Index vertex_at(const PolygonMesh& mesh, const Vec3& p) {
    const auto at = std::find(mesh.positions.begin(), mesh.positions.end(), p);
    REQUIRE(at != mesh.positions.end());
    return static_cast<Index>(at - mesh.positions.begin());
}

void check_closed(const PolygonMesh& mesh) {
    const Topology t = measure_topology(mesh);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK(t.euler == 2);
    CHECK(t.degenerate_facets == 0);
}

} // namespace

TEST_CASE("an edge of a closed surface becomes a vertex", "[mesh]") {
    PolygonMesh mesh = grid_cube(4);
    const std::size_t vertices = mesh.vertex_count();
    const std::array edges{first_side(mesh, 5), first_side(mesh, 60)};
    CHECK(collapse(mesh, edges) == 2);
    for (const EdgeCollapse& edge : edges) CHECK(mesh.positions[edge.to] == edge.position);
    CHECK(remove_isolated_vertices(mesh) == 2);
    CHECK(mesh.vertex_count() == vertices - 2);
    check_closed(mesh);
    CHECK(measure_topology(mesh).triangles == 4);
}

TEST_CASE("a quad collapses along its diagonal", "[mesh]") {
    PolygonMesh mesh = grid_cube(4);
    const std::size_t facets = mesh.facet_count();
    const Index from = vertex_at(mesh, {1, 1, 4}), to = vertex_at(mesh, {2, 2, 4});
    CHECK(collapse(mesh, std::array{EdgeCollapse{from, to, Vec3(2, 2, 4)}}) == 1);
    CHECK(mesh.facet_count() == facets - 1);
    CHECK(remove_isolated_vertices(mesh) == 1);
    check_closed(mesh);
    CHECK(measure_topology(mesh).triangles == 0);
}

TEST_CASE("an edge whose collapse would fold facets onto each other stays where it is", "[mesh]") {
    PolygonMesh tetrahedron = support::tetrahedron();
    PolygonMesh mesh = grid_cube(3);
    const EdgeCollapse side = first_side(mesh, 13);
    const EdgeCollapse far{side.from, vertex_at(mesh, {0, 0, 3}), side.position};
    const EdgeCollapse point{side.from, side.from, side.position};
    const EdgeCollapse turns_over{side.from, side.to, side.position + Vec3(2, 2, 2)};
    const PolygonMesh before = mesh, tetrahedron_before = tetrahedron;

    CHECK(collapse(tetrahedron, std::array{first_side(tetrahedron, 0)}) == 0);
    CHECK(collapse(mesh, std::array{far, point, turns_over}) == 0);
    CHECK(tetrahedron.corners == tetrahedron_before.corners);
    CHECK(tetrahedron.positions == tetrahedron_before.positions);
    CHECK(mesh.corners == before.corners);
    CHECK(mesh.positions == before.positions);
}

TEST_CASE("a facet left without area is united with the next one", "[mesh]") {
    PolygonMesh mesh = grid_cube(4);
    const Index from = vertex_at(mesh, {1, 2, 4}), to = vertex_at(mesh, {1, 1, 4});
    const Vec3 place = mesh.positions[to];
    mesh.positions[vertex_at(mesh, {2, 2, 4})] = Vec3(1.5, 1, 4); // between `to` and (2, 1, 4)
    const std::size_t facets = mesh.facet_count();
    CHECK(collapse(mesh, std::array{EdgeCollapse{from, to, place}}) == 1);
    CHECK(mesh.facet_count() == facets - 1);
    CHECK(measure_topology(mesh).larger == 1);
    remove_isolated_vertices(mesh);
    check_closed(mesh);
}

TEST_CASE("whatever edges are asked for, a closed manifold stays one", "[mesh]") {
    PolygonMesh mesh = grid_cube(3);
    std::vector<EdgeCollapse> edges;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) edges.push_back(first_side(mesh, f));
    CHECK(collapse(mesh, edges) > 10);
    remove_isolated_vertices(mesh);
    check_closed(mesh);
    std::vector<int> facets(mesh.vertex_count(), 0);
    for (Index v : mesh.corners) ++facets[v];
    CHECK(*std::min_element(facets.begin(), facets.end()) >= 3);
}

TEST_CASE("an edge between two borders stays", "[mesh]") {
    PolygonMesh strip;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 2; ++y) strip.positions.emplace_back(x, y, 0);
    strip.add_facet(std::array<Index, 4>{0, 2, 3, 1});
    strip.add_facet(std::array<Index, 4>{2, 4, 5, 3});
    const std::array<EdgeCollapse, 1> rung{{{2, 3, Vec3(1, 0.5, 0)}}};
    CHECK(collapse(strip, rung) == 0);
    CHECK(strip.facet(0).size() == 4);
    CHECK(strip.positions[3] == Vec3(1, 1, 0));
}
