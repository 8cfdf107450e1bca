#include "hsdm/simplify/quadric.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

Plane plane(const Vec3& direction, const Vec3& through) {
    const Vec3 normal = direction.normalized();
    return {normal, normal | through};
}

Quadric of(std::initializer_list<const Plane*> planes, const Vec3& at) {
    Quadric sum;
    sum.add_point(at);
    for (const Plane* p : planes) sum.add_shared(*p, 1);
    return sum;
}

} // namespace

TEST_CASE("shared planes meet exactly, however unlike their weights and however small their angle",
          "[simplify]") {
    const Vec3 meeting(1, 2, 3);
    const double angle = 0.05;
    const Plane one = plane({0, -std::sin(angle / 2), std::cos(angle / 2)}, meeting);
    const Plane two = plane({0, std::sin(angle / 2), std::cos(angle / 2)}, meeting);
    const Plane end = plane({1, 0, 0}, meeting);
    Quadric sum;
    sum.add_point({1.2, 2.3, 3.1});
    for (int k = 0; k < 100; ++k) sum.add_shared(one, 7);
    sum.add_shared(two, 1e-3);
    CHECK((sum.minimum() - Vec3(1.2, 2, 3)).norm() < 1e-9); // free along the line of both
    CHECK(sum.rms(sum.minimum()) < 1e-12);
    sum.add_shared(end, 1e-6);
    CHECK((sum.minimum() - meeting).norm() < 1e-9);
    CHECK(std::abs(sum.rms(meeting + Vec3(0.5, 0, 0)) - 0.5) < 1e-12); // of the farthest, not of all
}

TEST_CASE("sums of quadrics have each shared plane once, and what is beyond four like any other",
          "[simplify]") {
    std::vector<Plane> planes; // of the tip of a pyramid
    const Vec3 tip(0.2, 0.1, 0.7);
    for (int k = 0; k < 6; ++k) planes.push_back(plane({std::cos(k), std::sin(k), 0.3}, tip));
    Quadric sum = of({&planes[0], &planes[1]}, {0, 0, 0});
    sum += of({&planes[1], &planes[2]}, {0, 0, 0});
    sum += of({&planes[2], &planes[3], &planes[0]}, {0, 0, 0});
    CHECK((sum.minimum() - tip).norm() < 1e-9);
    std::array<Vec3, Quadric::most_shared> normals;
    CHECK(sum.shared_normals(normals).size() == 4);
    sum += of({&planes[4], &planes[5]}, {0, 0, 0});
    CHECK((sum.minimum() - tip).norm() < 1e-9);
    CHECK(sum.rms(tip) < 1e-9);
    CHECK(sum.rms(tip + planes[5].normal * 0.1) > 0.02);
    CHECK(sum.shared_normals(normals).empty());
}

TEST_CASE("other planes count by their share of the area beside shared ones", "[simplify]") {
    const Plane ground = plane({0, 0, 1}, {0, 0, 0});
    Quadric sum = of({&ground}, {0, 0, 0});
    std::array<Vec3, Quadric::most_shared> normals;
    sum.add_plane({1, 0, 0}, {0.5, 0, 0}, 0.001);
    CHECK(sum.shared_normals(normals).size() == 1); // next to nothing
    CHECK(sum.rms({0, 0, 0}) < 0.02);
    sum.add_plane({1, 0, 0}, {0.5, 0, 0}, 1);
    CHECK(sum.shared_normals(normals).empty());
    CHECK(sum.rms({0, 0, 0}) > 0.3);
    CHECK((sum.minimum() - Vec3(0.5, 0, 0)).norm() < 1e-9);
}

TEST_CASE("of shared planes that do not meet the farthest from a place are dropped", "[simplify]") {
    const Plane top = plane({0, 0, 1}, {0, 0, 0.05}), bottom = plane({0, 0, -1}, {0, 0, -0.05});
    const Plane rim = plane({1, 0, 0}, {0, 0, 0}), side = plane({0, 1, 0}, {0, 0, 0});
    const Vec3 at(0.001, 0, 0.04);
    Quadric corner = of({&top, &bottom, &rim, &side}, at);
    CHECK(corner.rms(corner.minimum()) > 0.04);
    corner.drop_shared(at, 0.01);
    CHECK(corner.rms(corner.minimum()) < 1e-9);
    CHECK((corner.minimum() - Vec3(0, 0, 0.05)).norm() < 1e-9);
    // Strips beside each other at the end of a shaft: the end stays, though it is farther.
    const Plane end = plane({1, 0, 0}, {-0.02, 0, 0});
    const Plane left = plane({0, -0.3, 1}, {0, -0.1, 0}), middle = plane({0, 0, 1}, {0, 0, 0.01}),
                right = plane({0, 0.3, 1}, {0, 0.1, 0});
    Quadric end_of_line = of({&end, &left, &middle, &right}, {0, 0.03, 0});
    end_of_line.drop_shared({0, 0.03, 0}, 0.001);
    CHECK(std::abs(end_of_line.minimum()[0] + 0.02) < 1e-9);
    CHECK(end_of_line.rms(end_of_line.minimum()) < 1e-9);
    Quadric fits = of({&top, &rim, &side}, at);
    fits.drop_shared(at, 0.01);
    std::array<Vec3, Quadric::most_shared> normals;
    CHECK(fits.shared_normals(normals).size() == 3);
}
