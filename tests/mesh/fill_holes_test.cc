#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

using namespace hsdm;

namespace {

/// A torus of quads, m x n, outward.
PolygonMesh torus(Index m, Index n) {
    PolygonMesh mesh;
    for (Index i = 0; i < m; ++i)
        for (Index j = 0; j < n; ++j) {
            const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
            const double r = 3 + std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(v));
        }
    for (Index i = 0; i < m; ++i)
        for (Index j = 0; j < n; ++j)
            mesh.add_facet(std::array{i * n + j, (i + 1) % m * n + j, (i + 1) % m * n + (j + 1) % n,
                                      i * n + (j + 1) % n});
    return mesh;
}

template <class Keep>
PolygonMesh keep_facets(const PolygonMesh& mesh, const Keep& keep) {
    PolygonMesh kept;
    kept.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (keep(f)) kept.add_facet(mesh.facet(f));
    return kept;
}

void check_manifold(const PolygonMesh& mesh) {
    const Topology topology = measure_topology(mesh);
    CHECK(topology.manifold());
    CHECK(topology.misoriented_edges == 0);
    CHECK(topology.degenerate_facets == 0);
    CHECK(topology.duplicate_facets == 0);
}

/// A cone of n triangles without its base.
PolygonMesh cone(Index n, double height) {
    PolygonMesh mesh;
    for (Index i = 0; i < n; ++i)
        mesh.positions.emplace_back(std::cos(2 * std::numbers::pi * i / n),
                                    std::sin(2 * std::numbers::pi * i / n), 0);
    mesh.positions.emplace_back(0, 0, height);
    for (Index i = 0; i < n; ++i) mesh.add_facet(std::array{i, (i + 1) % n, n});
    return mesh;
}

} // namespace

TEST_CASE("a missing quad is put back as it was", "[holes]") {
    PolygonMesh mesh = keep_facets(torus(24, 12), [](std::size_t f) { return f != 40 && f != 100; });
    CHECK(boundary_loops(mesh).size() == 2);
    const FillHolesCounts counts = fill_holes(mesh);
    CHECK(counts.closed == 2);
    CHECK(counts.facets == 2);
    const Topology topology = measure_topology(mesh);
    CHECK(topology.closed());
    CHECK(topology.euler == 0);
    CHECK(topology.quads == 24 * 12);
    check_manifold(mesh);
}

TEST_CASE("the direction of a boundary loop is that of the facet that closes it", "[holes]") {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    const BoundaryLoops loops = boundary_loops(mesh);
    REQUIRE(loops.size() == 1);
    CHECK(std::vector<Index>(loops[0].begin(), loops[0].end()) == std::vector<Index>{1, 0, 2});
}

TEST_CASE("random holes are closed and the surface stays what it was", "[holes]") {
    std::mt19937 random(3);
    const double whole = measure_topology(torus(40, 20)).signed_volume;
    for (int round = 0; round < 20; ++round) {
        PolygonMesh mesh = keep_facets(torus(40, 20), [&](std::size_t) { return random() % 10 != 0; });
        CHECK(fill_holes(mesh, {.max_edges = FillHolesOptions::no_limit}).refused == 0);
        check_manifold(mesh); // although vertices had several fans before
        CHECK(measure_topology(mesh).closed());
        CHECK(measure_topology(mesh).euler == 0);
        CHECK(measure_topology(mesh).signed_volume == Approx(whole).epsilon(0.05));
    }
}

TEST_CASE("loops longer or wider than asked for stay open", "[holes]") {
    const PolygonMesh open = cone(12, 1);
    PolygonMesh mesh = open;
    CHECK(fill_holes(mesh).closed == 0); // 12 edges, 8 by default
    FillHolesOptions options;
    options.max_edges = FillHolesOptions::no_limit;
    options.max_diameter = 2;
    CHECK(fill_holes(mesh, options).closed == 0);
    CHECK(mesh.corners == open.corners);
    options.max_diameter = 3;
    CHECK(fill_holes(mesh, options).closed == 1);
    CHECK(measure_topology(mesh).closed());
    CHECK(measure_topology(mesh).signed_volume > 0);
    CHECK(measure_topology(mesh).quads >= 3);
    check_manifold(mesh);
}

TEST_CASE("loops stay open for which that is asked", "[holes]") {
    PolygonMesh mesh = keep_facets(torus(16, 8), [](std::size_t f) { return f != 10 && f != 70; });
    const Index corner = torus(16, 8).facet(70)[0];
    FillHolesOptions options;
    std::size_t asked = 0;
    options.stays_open = [&](std::span<const Index> loop) {
        ++asked;
        return std::ranges::find(loop, corner) != loop.end();
    };
    const FillHolesCounts counts = fill_holes(mesh, options);
    CHECK(asked == 2);
    CHECK(counts.closed == 1);
    CHECK(counts.refused == 0);
    const BoundaryLoops left = boundary_loops(mesh);
    REQUIRE(left.size() == 1);
    CHECK(std::ranges::find(left[0], corner) != left[0].end());
}

TEST_CASE("long loops are closed too", "[holes]") {
    PolygonMesh mesh = cone(700, 1);
    CHECK(fill_holes(mesh, {.max_edges = FillHolesOptions::no_limit}).closed == 1);
    CHECK(measure_topology(mesh).closed());
    check_manifold(mesh);
}

TEST_CASE("a lone facet is not covered by its own reverse", "[holes]") {
    for (Index n : {3u, 4u, 6u}) {
        PolygonMesh mesh;
        std::vector<Index> facet;
        for (Index i = 0; i < n; ++i) {
            mesh.positions.emplace_back(std::cos(2 * std::numbers::pi * i / n),
                                        std::sin(2 * std::numbers::pi * i / n), 0);
            facet.push_back(i);
        }
        mesh.add_facet(facet);
        CHECK(fill_holes(mesh).refused == 1);
        CHECK(mesh.facet_count() == 1);
    }
}

TEST_CASE("a patch is not folded shut", "[holes]") {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0.1}, {2, 1, 0}};
    mesh.add_facet(std::array<Index, 4>{0, 1, 4, 3});
    mesh.add_facet(std::array<Index, 4>{1, 2, 5, 4});
    CHECK(fill_holes(mesh).refused == 1);
    CHECK(mesh.facet_count() == 2);
}

TEST_CASE("insisting closes what is refused otherwise", "[holes]") {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0.1}, {2, 1, 0}};
    mesh.normals.assign(6, Vec3(0, 0, 1));
    mesh.properties.push_back({"number", VertexProperty::Type::float64, {0, 1, 2, 3, 4, 5}});
    mesh.add_facet(std::array<Index, 4>{0, 1, 4, 3});
    mesh.add_facet(std::array<Index, 4>{1, 2, 5, 4});
    const FillHolesCounts counts = fill_holes(mesh, {.insist = true});
    CHECK(counts.refused == 0);
    CHECK(counts.vertices == 1);
    CHECK(mesh.vertex_count() == 7);
    CHECK(mesh.normals.size() == 7);
    CHECK(mesh.properties[0].values.size() == 7);
    CHECK(measure_topology(mesh).closed());
    check_manifold(mesh);
}

TEST_CASE("an edge that exists is not used a second time", "[holes]") {
    // A fan over corners 0, 1, 2 leaves the loop 0, 1, 2, 3 whose diagonal 0-2 is an edge already.
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, -1, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 0, -1}};
    mesh.add_facet(std::array<Index, 3>{0, 2, 4});
    mesh.add_facet(std::array<Index, 3>{2, 0, 5});
    mesh.add_facet(std::array<Index, 3>{0, 4, 1});
    mesh.add_facet(std::array<Index, 3>{2, 1, 4});
    mesh.add_facet(std::array<Index, 3>{0, 3, 5});
    mesh.add_facet(std::array<Index, 3>{2, 5, 3});
    check_manifold(mesh);
    const FillHolesCounts counts = fill_holes(mesh, {.max_bend = std::numbers::pi, .quads = false});
    CHECK(counts.loops == 1);
    CHECK(counts.closed == 1); // by the other diagonal
    CHECK(counts.facets == 2);
    check_manifold(mesh);
    const Topology topology = measure_topology(mesh);
    CHECK(topology.closed());
    CHECK(topology.euler == 2);
}

TEST_CASE("holes of random soups leave a manifold", "[holes]") {
    std::mt19937 random(17);
    std::size_t filled = 0;
    for (int round = 0; round < 200; ++round) {
        PolygonMesh soup;
        for (unsigned i = 0; i < 12; ++i)
            soup.positions.emplace_back(random() % 1000, random() % 1000, random() % 1000);
        for (unsigned f = 0; f < random() % 40; ++f) {
            std::vector<Index> facet(3 + random() % 3);
            for (Index& v : facet) v = static_cast<Index>(random() % 12);
            soup.add_facet(facet);
        }
        make_manifold(soup);
        const FillHolesOptions options{
            .max_edges = FillHolesOptions::no_limit, .max_bend = std::numbers::pi, .insist = round % 2 == 1};
        filled += fill_holes(soup, options).closed;
        const Topology topology = measure_topology(soup);
        CHECK(topology.manifold());
        CHECK(topology.misoriented_edges == 0);
        CHECK(topology.duplicate_facets == 0);
    }
    CHECK(filled > 200);
}
