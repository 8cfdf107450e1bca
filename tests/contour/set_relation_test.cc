#include "hsdm/contour/plane_area.hh"
#include "hsdm/contour/set_relation.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

/// A set of points spread evenly over a disc-like patch of the given radius, voxel size 1.
NormalSet patch(const Vec3& centroid, Vec3 normal, double radius = 0.5) {
    normal.normalize();
    NormalSet set{centroid, normal, 20, 0, {}};
    const double variance = radius * radius / 3;
    for (unsigned k = 0; k < 3; ++k) set.spread.moments[k] = variance * (1 - normal[k] * normal[k]);
    set.spread.moments[3] = -variance * normal[0] * normal[1];
    set.spread.moments[4] = -variance * normal[1] * normal[2];
    set.spread.moments[5] = -variance * normal[2] * normal[0];
    return set;
}

const RelationTest& test() {
    static const RelationTest t(RelationOptions{}, 1);
    return t;
}

} // namespace

TEST_CASE("neighbours on a plane and on an arc are one sheet", "[contour]") {
    CHECK(test()(patch({0, 0, 0}, {0, 0, 1}), patch({1, 0, 0}, {0, 0, 1})) == Relation::smooth);
    const double a = 0.5; // radians of a circle of radius 2
    const Vec3 n(std::sin(a), 0, std::cos(a));
    CHECK(test()(patch({0, 0, 2}, {0, 0, 1}), patch(n * 2, n)) == Relation::smooth);
}

TEST_CASE("parallel sheets half a voxel apart are two, whichever way they face", "[contour]") {
    CHECK(test()(patch({0, 0, 0}, {0, 0, 1}), patch({0, 0, 0.5}, {0, 0, 1})) == Relation::none);
    CHECK(test()(patch({0, 0, 0.2}, {0, 0, 1}), patch({0, 0, 0}, {0, 0, -1})) == Relation::none);
}

TEST_CASE("sheets that end where their planes meet make a crease, convex or concave", "[contour]") {
    const NormalSet top = patch({-0.5, 0, 0}, {0, 0, 1});
    CHECK(test()(top, patch({0, 0, -0.5}, {1, 0, 0})) == Relation::convex);
    CHECK(test()(patch({0, 0, -0.5}, {1, 0, 0}), top) == Relation::convex);
    CHECK(test()(top, patch({0, 0, 0.5}, {-1, 0, 0})) == Relation::concave);
}

TEST_CASE("planes that would meet far from the points of either make no crease", "[contour]") {
    const NormalSet top = patch({-0.5, 0, 0}, {0, 0, 1});
    CHECK(test()(top, patch({0, 0, -2}, {1, 0, 0})) == Relation::none);
    CHECK(test()(top, patch({-0.5, 0, -0.5}, {1, 0, 0})) == Relation::none); // top goes on beyond
}

TEST_CASE("relations out of range are refused", "[contour]") {
    RelationOptions options;
    options.smooth_angle = 2;
    CHECK_THROWS_AS(RelationTest(options, 1), OptionError);
    options = {};
    options.crease_gap = 0;
    CHECK_THROWS_AS(RelationTest(options, 1), OptionError);
}

TEST_CASE("the area of a plane in a voxel, whole and clipped", "[contour]") {
    const Vec3 z(0, 0, 1);
    CHECK(plane_area(z, 0.3, {0, 0, 0}, 1, {}) == Approx(1));
    CHECK(plane_area(z, 1.3, {0, 0, 0}, 1, {}) == Approx(0).margin(1e-12));
    const Vec3 diagonal = Vec3(1, 1, 0) / std::sqrt(2.0);
    CHECK(plane_area(diagonal, diagonal | Vec3(0.5, 0.5, 0), {0, 0, 0}, 1, {}) == Approx(std::sqrt(2.0)));
    const HalfSpace half{{1, 0, 0}, 0.25};
    CHECK(plane_area(z, 0.3, {0, 0, 0}, 1, {&half, 1}) == Approx(0.25));
}
