// Facets without an area go without leaving a hole.
#include "hsdm/contour/flat_facets.hh"
#include "hsdm/quality/topology.hh"
#include "support/check.hh"

#include <catch2/catch.hpp>

#include <numeric>

using namespace hsdm;

namespace {

/// A pyramid over a square base, with a vertex more on the way up one of its edges: `share` of the way from
/// the base to the top, where a triangle beside it has no area.
PolygonMesh pyramid(double share) {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    mesh.positions.push_back(mesh.positions[0] + share * (mesh.positions[4] - mesh.positions[0]));
    mesh.add_facet(std::array<Index, 4>{0, 3, 2, 1});
    mesh.add_facet(std::array<Index, 4>{0, 1, 4, 5});
    mesh.add_facet(std::array<Index, 3>{1, 2, 4});
    mesh.add_facet(std::array<Index, 3>{2, 3, 4});
    mesh.add_facet(std::array<Index, 3>{3, 0, 4});
    mesh.add_facet(std::array<Index, 3>{0, 5, 4});
    mesh.origin.resize(mesh.vertex_count());
    std::iota(mesh.origin.begin(), mesh.origin.end(), Index{0});
    return mesh;
}

} // namespace

TEST_CASE("facets without an area collapse, and the surface stays closed", "[contour]") {
    for (const double share : {0.3, 0.6, 0.0, 1.0, 1e-15}) { // in one line, or at one place
        INFO("at " << share << " of the edge");
        PolygonMesh mesh = pyramid(share);
        REQUIRE(measure_topology(mesh).closed());
        CHECK(collapse_flat_facets(Vec3(10, 0, 0), mesh) == 1);
        CHECK(mesh.facet_count() == 5);
        CHECK(mesh.vertex_count() == 5);
        CHECK(support::faults(mesh) == "");
        CHECK(measure_topology(mesh).closed());
        CHECK(collapse_flat_facets(Vec3(10, 0, 0), mesh) == 0);
    }
}

namespace {

PolygonMesh mesh_of(std::vector<Vec3> positions, const std::vector<std::vector<Index>>& facets) {
    PolygonMesh mesh;
    mesh.positions = std::move(positions);
    for (const std::vector<Index>& facet : facets) mesh.add_facet(facet);
    mesh.origin.resize(mesh.vertex_count());
    std::iota(mesh.origin.begin(), mesh.origin.end(), Index{0});
    return mesh;
}

} // namespace

TEST_CASE("facets without an area go where vertices lose their third facet by it", "[contour]") {
    // A tetrahedron: its tip three vertices at one place, or a facet in one line along an edge.
    const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0), tip(0.5, 0.5, 2);
    const auto mesh = GENERATE_COPY(values(
        {mesh_of({a, b, c, tip, tip, tip}, {{0, 2, 1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {3, 4, 5}}),
         mesh_of({a, b, c, tip, 0.25 * tip, 0.5 * tip},
                 {{0, 2, 1}, {0, 1, 3, 4}, {2, 0, 4, 5, 3}, {1, 2, 3}, {4, 3, 5}})}));
    PolygonMesh changed = mesh;
    REQUIRE(measure_topology(mesh).closed());
    CHECK(collapse_flat_facets(Vec3(0, 0, 0), changed) > 0);
    CHECK(support::faults(changed) == "");
    CHECK(changed.vertex_count() == 4);
    CHECK(measure_topology(changed).closed());
    CHECK(measure_topology(changed).euler == 2);
    CHECK(signed_volume(changed) == Approx(signed_volume(mesh)));
    CHECK(collapse_flat_facets(Vec3(0, 0, 0), changed) == 0);
}

TEST_CASE("a facet in one line becomes part of the one beyond", "[contour]") {
    const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0), tip(0, 0, 2);
    const PolygonMesh mesh = mesh_of({a, b, c, tip, {0.5, 0, 1.5}}, // the last facet along an edge
                                     {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3, 4}, {3, 1, 4}});
    PolygonMesh changed = mesh;
    REQUIRE(measure_topology(mesh).closed());
    CHECK(unite_flat_facets(Vec3(0, 0, 0), changed) == 1);
    CHECK(changed.facet_count() == 4);
    CHECK(changed.positions == mesh.positions);
    CHECK(measure_topology(changed).closed());
    CHECK(measure_topology(changed).degenerate_facets == 0);
    CHECK(signed_volume(changed) == Approx(8.0 / 6));
    CHECK(unite_flat_facets(Vec3(0, 0, 0), changed) == 0);
}
