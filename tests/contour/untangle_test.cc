#include "hsdm/contour/untangle.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// A grid of unit quads at height z.
void add_sheet(PolygonMesh& mesh, int side, double z) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    for (int i = 0; i <= side; ++i)
        for (int k = 0; k <= side; ++k) mesh.positions.emplace_back(i, k, z);
    const auto at = [&](int i, int k) { return base + static_cast<Index>(i * (side + 1) + k); };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            mesh.add_facet(std::array{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
}

/// A vertex of the lower sheet.
constexpr std::size_t spike = 4 * 9 + 4;

/// The lower one sticks through the upper one at the spike.
PolygonMesh two_sheets_that_meet() {
    PolygonMesh mesh;
    add_sheet(mesh, 8, 0);
    add_sheet(mesh, 8, 0.4);
    mesh.positions[spike][2] = 0.6;
    return mesh;
}

UntangleOptions options() {
    const UntangleOptions result{.nearby = 1};
    return result;
}

} // namespace

TEST_CASE("a vertex that sticks through another sheet is taken back", "[untangle]") {
    PolygonMesh mesh = two_sheets_that_meet();
    const std::vector<Vec3> before = mesh.positions;
    const std::vector<Index> corners = mesh.corners;
    REQUIRE(find_self_intersections(mesh).triangle_pairs > 0);

    const UntangleCounts counts = untangle(mesh, options());
    CHECK(counts.before > 0);
    CHECK(counts.after == 0);
    CHECK(counts.moved > 0);
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
    CHECK(mesh.corners == corners);
    for (std::size_t v = 0; v < before.size(); ++v)
        if ((before[v] - before[spike]).norm() > 3) CHECK(mesh.positions[v] == before[v]);
}

TEST_CASE("a mesh without intersections is left as it is", "[untangle]") {
    PolygonMesh mesh;
    add_sheet(mesh, 4, 0);
    const std::vector<Vec3> before = mesh.positions;
    const UntangleCounts counts = untangle(mesh, options());
    CHECK(counts.before == 0);
    CHECK(counts.moved == 0);
    CHECK(mesh.positions == before);
}

TEST_CASE("intersections that moving vertices cannot end are counted, and never grow", "[untangle]") {
    PolygonMesh mesh;
    add_sheet(mesh, 6, 0);
    add_sheet(mesh, 6, 0.4);
    for (std::size_t v = 49; v < mesh.vertex_count(); ++v)
        mesh.positions[v][2] = mesh.positions[v][0] - 3.2; // through
    const std::size_t before = find_self_intersections(mesh).triangle_pairs;
    const UntangleCounts counts = untangle(mesh, options());
    CHECK(counts.before == before);
    CHECK(counts.after == find_self_intersections(mesh).triangle_pairs);
    CHECK(counts.after <= before);
    CHECK(counts.after > 0);
    // The sheets cross where z = x - 3.2; a facet there has its corners within a facet's diagonal.
    CHECK(std::abs(counts.first[0] - 3.2) < 1.5);
    CHECK(std::abs(counts.first[2]) < 1.5);
}

TEST_CASE("no vertex moves farther than its reach", "[untangle]") {
    PolygonMesh mesh;
    add_sheet(mesh, 8, 0);
    add_sheet(mesh, 8, 0.4);
    mesh.positions[4 * 9 + 4][2] = 0.6;
    const std::vector<Vec3> before = mesh.positions;
    UntangleOptions short_reach = options();
    short_reach.reach = 0.25;
    untangle(mesh, short_reach);
    for (std::size_t v = 0; v < before.size(); ++v)
        CHECK((mesh.positions[v] - before[v]).norm() <= 0.25 + 1e-12);
}

TEST_CASE("what still sticks through another sheet is merged into its neighbours, and the rest stays",
          "[untangle]") {
    PolygonMesh mesh = two_sheets_that_meet();
    const std::vector<Vec3> before = mesh.positions;
    const std::size_t facets = mesh.facet_count();

    const UntangleCounts none = mend_tangles(mesh, 1, 0);
    CHECK(none.after == none.before);
    CHECK(mesh.facet_count() == facets);

    const UntangleCounts counts = mend_tangles(mesh, 1);
    CHECK(counts.before > 0);
    CHECK(counts.after == 0);
    CHECK(counts.moved >= 1);
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
    CHECK(mesh.positions == before);
    remove_isolated_vertices(mesh);
    CHECK(mesh.vertex_count() == before.size() - counts.moved);
    CHECK(measure_topology(mesh).euler == 2); // of two discs
    CHECK(measure_topology(mesh).boundary_loops == 2);
}

TEST_CASE("mending leaves fewer intersections or none, and the topology as it is", "[untangle]") {
    int ended = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        INFO("seed " << seed);
        support::Random random(seed);
        PolygonMesh mesh;
        add_sheet(mesh, 8, 0);
        add_sheet(mesh, 8, 0.5);
        for (int i = 0; i < 6; ++i) { // crumpled in the middle
            // One draw a statement: compilers differ in the order within one.
            std::size_t v = random.below(2) * 81;
            v += 9 * (3 + random.below(3));
            v += 3 + random.below(3);
            for (unsigned axis = 0; axis < 3; ++axis)
                mesh.positions[v][axis] += axis < 2 ? random.uniform(-0.6, 0.6) : random.uniform(-0.8, 0.8);
        }
        const std::vector<Vec3> before = mesh.positions;
        const UntangleCounts counts = mend_tangles(mesh, 1);
        CHECK(find_self_intersections(mesh).triangle_pairs == counts.after);
        CHECK(counts.after <= counts.before);
        if (counts.moved > 0) CHECK(counts.after < counts.before);
        ended += counts.before > 0 && counts.after == 0;
        CHECK(mesh.positions == before);
        remove_isolated_vertices(mesh);
        CHECK(measure_topology(mesh).manifold());
        CHECK(measure_topology(mesh).euler == 2);
        CHECK(measure_topology(mesh).boundary_loops == 2);
    }
    CHECK(ended >= 20); // of 40: not every crumpled sheet can be mended where its points are
}

TEST_CASE("a quad that passes through others along one diagonal is cut along the other one", "[untangle]") {
    // Along the first diagonal the quad is a ridge at 1, along the other a valley at 0; no edge of a border
    // collapses.
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 1},       {1, 0, 0},     {1, 1, 1},    {0, 1, 0},
                      {0.5, 0.5, 0.8}, {0.6, 0.5, 2}, {0.4, 0.5, 2}};
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    mesh.add_facet(std::array<Index, 3>{4, 5, 6});
    const UntangleCounts counts = mend_tangles(mesh, 1);
    CHECK(counts.before > 0);
    CHECK(counts.after == 0);
    CHECK(mesh.facet_count() == 3);
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
    CHECK(measure_topology(mesh).boundary_edges == 7);
}

TEST_CASE("two facets folded onto each other become one", "[untangle]") {
    PolygonMesh mesh; // a square, a triangle beyond one of its sides, and that triangle again facing back
    mesh.positions = {{0, 0, 0}, {0.5, -0.4, 0.1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_facet(std::array<Index, 5>{0, 1, 2, 3, 4});
    mesh.add_facet(std::array<Index, 3>{0, 2, 1});
    const UntangleCounts counts = mend_tangles(mesh, 1);
    CHECK(counts.before > 0);
    CHECK(counts.after == 0);
    REQUIRE(mesh.facet_count() == 1);
    CHECK(std::ranges::count(mesh.facet(0), Index(1)) == 0);
    CHECK(measure_topology(mesh).boundary_edges == 4);
}

TEST_CASE("no facet is made over the vertices of another", "[untangle]") {
    PolygonMesh mesh; // what a tangle would be united to is the other side of a pillow
    mesh.positions = {{0, 0, 0}, {0.5, -0.4, 0.1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_facet(std::array<Index, 5>{0, 1, 2, 3, 4});
    mesh.add_facet(std::array<Index, 3>{0, 2, 1});
    mesh.add_facet(std::array<Index, 4>{4, 3, 2, 0});
    mend_tangles(mesh, 1);
    CHECK(measure_topology(mesh).euler == 2);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (std::size_t g = 0; g < f; ++g)
            CHECK_FALSE(std::ranges::is_permutation(mesh.facet(f), mesh.facet(g)));
}

TEST_CASE("options of untangling out of range are refused", "[untangle]") {
    PolygonMesh mesh;
    add_sheet(mesh, 2, 0);
    CHECK_THROWS_AS(untangle(mesh, UntangleOptions{}), OptionError); // nearby is not set
    UntangleOptions bad = options();
    bad.step = 0;
    CHECK_THROWS_AS(untangle(mesh, bad), OptionError);
    bad = options();
    bad.rounds = -1;
    CHECK_THROWS_AS(untangle(mesh, bad), OptionError);
}
