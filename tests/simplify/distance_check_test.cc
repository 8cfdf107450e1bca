#include "hsdm/simplify/distance_check.hh"
#include "support/meshes.hh"
#include "support/pose.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace hsdm;

namespace {

constexpr Index fine_side = 9; // vertices

/// A roof of quads over a square, 1 high along its middle.
PolygonMesh roof() {
    return support::quad_sheet(fine_side - 1, fine_side - 1,
                               [](Index x, Index y) { return Vec3(x, y, 1 - std::abs(double(x) - 4) / 4); });
}

/// Vertices of the roof's own, and one quad over four of them.
PolygonMesh quad_over(const PolygonMesh& roof, std::array<Index, 4> corners) {
    PolygonMesh mesh;
    for (Index v : corners) mesh.positions.push_back(roof.positions[v]);
    mesh.origin.assign(corners.begin(), corners.end());
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    return mesh;
}

/// Looks at one mesh after the other.
struct Sequence {
    DistanceCheck& check;
    PolygonMesh last;

    FarPlaces find_far(const PolygonMesh& mesh) {
        const Unchanged same = find_unchanged(last, mesh);
        last = mesh;
        return check.find_far(mesh, same);
    }
};

} // namespace

TEST_CASE("a facet over the fine mesh's own vertices is looked at", "[simplify]") {
    const PolygonMesh fine = roof();
    DistanceCheck check(fine, nullptr, {}, 0.1, 1);
    Sequence meshes{check, {}};
    CHECK(meshes.find_far(fine).size() == 0);
    // From eaves to eaves, under the ridge.
    const FarPlaces under = meshes.find_far(
        quad_over(fine, {0, fine_side - 1, fine_side * fine_side - 1, fine_side * (fine_side - 1)}));
    CHECK(under.facets.size() == 1);
    CHECK(under.vertices.empty());
    CHECK(!under.fine_vertices.empty());
    // One slope of two.
    const FarPlaces slope = meshes.find_far(
        quad_over(fine, {0, 4, fine_side * (fine_side - 1) + 4, fine_side * (fine_side - 1)}));
    CHECK(slope.facets.empty());
    CHECK(slope.fine_vertices.size() == std::size_t{4} * fine_side);
}

TEST_CASE("what was near a facet that has gone is measured again, in any order of vertices", "[simplify]") {
    const PolygonMesh fine = roof();
    const std::vector<Vec3> points = {Vec3(1.5, 4, 0.375), Vec3(6.5, 4, 0.375), Vec3(6.5, 4, 3)};
    DistanceCheck check(fine, nullptr, points, 0.1, 1);
    Sequence meshes{check, {}};
    const std::array<Index, 4> left{0, 4, fine_side * (fine_side - 1) + 4, fine_side * (fine_side - 1)};
    const std::array<Index, 4> right{4, fine_side - 1, fine_side * fine_side - 1,
                                     fine_side * (fine_side - 1) + 4};
    PolygonMesh both = quad_over(fine, left);
    for (Index v : right) both.positions.push_back(fine.positions[v]);
    both.origin.insert(both.origin.end(), right.begin(), right.end());
    both.origin[4] = 1; // each vertex once
    both.origin[7] = 2;
    both.add_facet(std::array<Index, 4>{4, 5, 6, 7});
    CHECK(meshes.find_far(both).size() == 0);
    FarPoints far = check.find_far_points();
    CHECK(far.beyond == 1);
    CHECK(far.unreachable == 1); // the fine mesh is as far from it
    CHECK(far.points.empty());
    meshes.find_far(quad_over(fine, left));
    far = check.find_far_points();
    CHECK(far.beyond == 2);
    CHECK(far.points == std::vector<Index>{1, 2}); // the last one is farther than it need be
    PolygonMesh again;                             // the same facets, numbered the other way
    again.positions.assign(both.positions.rbegin(), both.positions.rend());
    again.origin.assign(both.origin.rbegin(), both.origin.rend());
    again.add_facet(std::array<Index, 4>{7, 6, 5, 4});
    again.add_facet(std::array<Index, 4>{3, 2, 1, 0});
    CHECK(meshes.find_far(again).size() == 0);
    CHECK(check.find_far_points().points.empty());
}

TEST_CASE("what was far from the fine mesh is so each time", "[simplify]") {
    const PolygonMesh fine = roof();
    DistanceCheck check(fine, nullptr, {}, 0.1, 1);
    Sequence meshes{check, {}};
    PolygonMesh lifted = fine;
    for (Vec3& p : lifted.positions) p[2] += p[0] < 3.5 ? 0.05 : 0.2;
    const FarPlaces first = meshes.find_far(lifted), second = meshes.find_far(lifted);
    CHECK(first.vertices.size() == std::size_t{5} * fine_side);
    CHECK(first.facets.size() == std::size_t{5} * (fine_side - 1));
    CHECK(second.vertices == first.vertices);
    CHECK(second.facets == first.facets);
}

TEST_CASE("of places that rounding puts beyond the bound each facet has one, whichever slope is nearer",
          "[simplify]") {
    constexpr double bound = 0.1, within = (1 - 1e-9) * bound;
    std::size_t facets = 0, wrong = 0;
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
        const support::Pose pose = support::random_pose(seed);
        const auto placed = [&](double x, double y, double z) { return pose.to_world(Vec3(x, y, z)); };
        const PolygonMesh valley = support::quad_sheet(
            2, 1, [&](Index x, Index y) { return placed(4.0 * x - 4, 4.0 * y, std::abs(4.0 * x - 4)); });
        // The first triangle lies on one slope. The second stands in the valley, its upper side the bound
        // away from either.
        const double height = std::sqrt(2) * within;
        const PolygonMesh mesh =
            support::mesh_of({placed(-1, 1, 1), placed(-2, 1, 2), placed(-1, 1.3, 1), placed(0, 1, height),
                              placed(0, 3, height), placed(0, 2, 0)},
                             {{0, 1, 2}, {3, 4, 5}});
        DistanceCheck check(valley, nullptr, {}, bound, 0.3);
        const FarPlaces far = Sequence{check, {}}.find_far(mesh);
        facets += far.facets.size();
        wrong += far.on_facets.size() != far.facets.size();
        for (const Vec3& place : far.on_facets)
            wrong += std::abs(check.to_fine().tree()(place) - within) > 1e-12;
    }
    CHECK(facets > 100);
    CHECK(facets < 900);
    CHECK(wrong == 0);
}

TEST_CASE("the bound is kept with room for rounding", "[simplify]") {
    constexpr double bound = 0.1;
    const PolygonMesh fine = roof();
    const Vec3 up = Vec3(-1, 0, 4).normalized(); // from the left slope
    for (const auto& [distance, far] :
         {std::pair{(1 - 1e-10) * bound, true}, std::pair{(1 - 1e-8) * bound, false}}) {
        const std::vector<Vec3> points = {Vec3(2, 4, 0.5) + up * distance};
        DistanceCheck check(fine, nullptr, points, bound, 1);
        Sequence meshes{check, {}};
        meshes.find_far(fine);
        CHECK(check.find_far_points().beyond == (far ? 1 : 0));
    }
}
