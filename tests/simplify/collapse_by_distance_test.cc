#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/collapse_by_distance.hh"
#include "hsdm/simplify/leaf_doublets.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <array>
#include <numbers>

using namespace hsdm;

namespace {

/// A tube of radius 1 round the z axis with flat ends, its rings turned against each other.
PolygonMesh tube(Index around, Index rings) {
    PolygonMesh mesh = support::quad_tube(around, rings - 1, [=](Index i, Index r) {
        const double angle = 2 * std::numbers::pi * (i + 0.3 * (r % 3)) / around;
        return Vec3(std::cos(angle), std::sin(angle), 0.2 * r);
    });
    std::vector<Index> low, high;
    for (Index i = 0; i < around; ++i) {
        low.push_back(around - 1 - i);
        high.push_back((rings - 1) * around + i);
    }
    mesh.add_facet(low);
    mesh.add_facet(high);
    return mesh;
}

bool on_rim(const PolygonMesh& mesh, Index v) {
    return mesh.positions[v][2] == 0 || mesh.positions[v][2] == mesh.positions.back()[2];
}

} // namespace

TEST_CASE("a tube keeps the vertices of its rims alone", "[simplify]") {
    const PolygonMesh fine = tube(48, 12);
    const SurfaceWalk surface(fine);
    const std::vector<DistanceCollapse> drops = find_distance_collapses(CollapsingMesh(fine), surface, 0.03);
    auto [mesh, stands_for, flipped] =
        collapse_by_distance(CollapsingMesh(fine), drops, std::vector<std::uint8_t>(fine.vertex_count(), 1));
    std::size_t inner = 0;
    for (Index v = 0; v < stands_for.size(); ++v) {
        if (on_rim(fine, v)) CHECK(stands_for[v] == v); // a crease of 90 degrees
        inner += stands_for[v] == v && !on_rim(fine, v);
    }
    CHECK(inner < 10 * 48 / 8); // of 480
    drop_replaced(mesh, stands_for);
    const Topology topology = measure_topology(mesh);
    CHECK(topology.closed());
    CHECK(topology.euler == 2);
    CHECK(topology.misoriented_edges + topology.nonmanifold_edges + topology.degenerate_facets == 0);
    CHECK(find_self_intersections(mesh).facet_pairs.empty());
    CHECK(points_to_mesh(sample_surface(mesh, 20000), surface.tree()).max < 1.2 * 0.03);
    CHECK(points_to_mesh(fine.positions, mesh).max < 1.2 * 0.03);
}

TEST_CASE("vertices that may not go stay, and nothing is joined to them", "[simplify]") {
    const PolygonMesh fine = tube(24, 9);
    const SurfaceWalk surface(fine);
    const std::vector<DistanceCollapse> drops = find_distance_collapses(CollapsingMesh(fine), surface, 0.1);
    std::vector<std::uint8_t> may_go(fine.vertex_count(), 1);
    REQUIRE(drops.size() > 20);
    for (std::size_t i = 0; i < drops.size(); i += 3) may_go[drops[i].vertex] = 0;
    const std::vector<Index> stands_for =
        collapse_by_distance(CollapsingMesh(fine), drops, may_go).stands_for;
    std::size_t gone = 0;
    for (Index v = 0; v < stands_for.size(); ++v) {
        if (stands_for[v] == v) continue;
        ++gone;
        CHECK(may_go[v] == 1);
        CHECK(may_go[stands_for[v]] == 1);
    }
    CHECK(gone > 0);
    CHECK(gone < drops.size());
}

TEST_CASE("any number of threads finds the same vertices to drop", "[simplify]") {
    const PolygonMesh fine = tube(200, 60);
    const SurfaceWalk surface(fine);
    const auto sides = [&](std::size_t threads) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<Index> found;
        for (const DistanceCollapse& drop : find_distance_collapses(CollapsingMesh(fine), surface, 0.01))
            found.push_back(drop.side);
        return found;
    };
    const std::vector<Index> one = sides(1);
    REQUIRE(one.size() > 1000);
    CHECK(sides(4) == one);
}
