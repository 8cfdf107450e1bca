#include "hsdm/normals/mend_normals.hh"
#include "hsdm/normals/steady_normals.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;
using support::in_general_pose;
using support::Solid;

namespace {

PointCloud with_flips(const Solid& solid, std::size_t points, double share) {
    PointCloud cloud = support::sample(solid, {.points = points});
    support::Random random(8);
    for (Vec3& n : cloud.normals)
        if (random.uniform() < share) n = -n;
    return cloud;
}

/// Share of the octree's normals that point into the solid.
double share_inward(const Octree& octree, const Solid& solid) {
    const double step = 1e-4 * octree.extent;
    std::size_t inward = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        inward += solid.contains(octree.positions[i] + octree.origin + octree.normals[i] * step);
    return static_cast<double>(inward) / static_cast<double>(octree.size());
}

} // namespace

TEST_CASE("consistent normals are not doubted, on thin parts and on rough scans neither", "[normals]") {
    const double spacing = std::sqrt(2.0 / 5000);
    for (const Solid& solid : {support::sphere(1), support::mechanical_part(), support::wedge(0.3, 1, 0.5),
                               support::box(Vec3(1, 1, 0.3 * spacing)), support::nested_spheres(1, 0.97)})
        CHECK_FALSE(check_normals(build_octree(support::sample(in_general_pose(solid), {.points = 5000})))
                        .doubtful());
    const PointCloud noisy = support::sample(support::mechanical_part(),
                                             {.points = 5000, .position_noise = 0.01, .normal_noise = 0.2});
    CHECK_FALSE(check_normals(build_octree(noisy)).doubtful());
    PointCloud inward = support::sample(support::sphere(1), {.points = 2000});
    for (Vec3& n : inward.normals) n = -n;
    CHECK_FALSE(check_normals(build_octree(inward)).doubtful());
}

TEST_CASE("normals flipped at random are found and turned back", "[normals]") {
    for (double share : {0.05, 0.5, 0.95})
        for (const Solid& solid :
             {in_general_pose(support::torus(1, 0.4)), in_general_pose(support::box(Vec3(1, 1, 1)))}) {
            INFO("share " << share);
            Octree octree = build_octree(with_flips(solid, 5000, share));
            CHECK(check_normals(octree).doubtful());
            const double wrong = share_inward(octree, solid);
            const std::size_t turned = mend_normals(octree);
            CHECK(share_inward(octree, solid) < 0.002);
            CHECK(static_cast<double>(turned)
                  == Approx(wrong * static_cast<double>(octree.size())).margin(10));
        }
}

TEST_CASE("whole faces that point inward are turned", "[normals]") {
    const Solid cube = support::box(Vec3(1, 1, 1));
    PointCloud cloud = support::sample(cube, {.points = 6000});
    for (Vec3& n : cloud.normals)
        if (n[0] > 0.5 || n[1] > 0.5 || n[2] > 0.5) n = -n;
    Octree octree = build_octree(cloud);
    CHECK(check_normals(octree).doubtful());
    mend_normals(octree);
    CHECK(share_inward(octree, cube) < 0.002);
}

TEST_CASE("a thin plate with flips, and an open sheet, follow the signs that most of their normals have",
          "[normals]") {
    const double spacing = std::sqrt(2.0 / 8000);
    const Solid plate = in_general_pose(support::box(Vec3(1, 1, 2 * spacing)));
    Octree octree = build_octree(with_flips(plate, 8000, 0.05));
    mend_normals(octree);
    CHECK(share_inward(octree, plate) < 0.005);

    const PointCloud sphere = with_flips(support::sphere(1), 6000, 0.05);
    for (double side : {-1.0, 1.0}) {
        PointCloud cap;
        for (std::size_t i = 0; i < sphere.size(); ++i)
            if (sphere.positions[i][2] > 0.5)
                cap.positions.push_back(sphere.positions[i]), cap.normals.push_back(sphere.normals[i] * side);
        Octree sheet = build_octree(cap);
        mend_normals(sheet);
        for (const Vec3& n : sheet.normals) CHECK(n[2] * side > 0);
    }
}

TEST_CASE("one half of a plate turned inside out is found and turned back", "[normals]") {
    const Solid plate = support::box(Vec3(1, 1, 2.5 * std::sqrt(2.0 / 8000)));
    PointCloud cloud = support::sample(plate, {.points = 8000});
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud.positions[i][0] > 0.1) cloud.normals[i] = -cloud.normals[i];
    Octree octree = build_octree(cloud);
    CHECK(check_normals(octree).doubtful());
    mend_normals(octree);
    CHECK(share_inward(octree, plate) < 0.005);
}

TEST_CASE("flipped normals that lie askew, as those smoothed over a fan of triangles, are turned back",
          "[normals]") {
    support::Random random(3);
    PointCloud cloud;
    std::vector<Vec3> right; // normals of the cone's side and foot
    const auto add = [&](const Vec3& position, const Vec3& normal, const Vec3& given) {
        cloud.positions.push_back(position);
        right.push_back(normal);
        cloud.normals.push_back(given.normalized() * (random.uniform() < 0.03 ? -1 : 1));
    };
    for (int i = 0; i < 8000; ++i) {
        const double angle = random.uniform(0, 6.28318), share = std::sqrt(random.uniform());
        const Vec3 out(std::cos(angle), std::sin(angle), 0), axis(0, 0, 1);
        const Vec3 side = (out * 2 + axis).normalized();
        if (i % 3 == 0)
            add(out * (0.5 * share), -axis, -axis);
        else // the corner of all triangles at the apex has the axis for its normal
            add(out * (0.5 * share) + axis * (1 - share), side, side * share + axis * (1 - share));
    }
    Octree octree = build_octree(cloud);
    CHECK(check_normals(octree).askew());
    mend_normals(octree);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        wrong += (octree.normals[i] | right[octree.source[i]]) < 0;
    INFO(wrong);
    CHECK(wrong < 20);
}

TEST_CASE("right normals of points that are all noise stay as they are", "[normals]") {
    PointCloud cloud =
        support::sample(support::sphere(1), {.points = 8000, .position_noise = 0.1, .normal_noise = 0.3});
    Octree octree = build_octree(cloud);
    const std::vector<Vec3> given = octree.normals;
    mend_normals(octree);
    CHECK(octree.normals == given);
}

TEST_CASE("the two sides of a wall thinner than points are apart keep theirs", "[normals]") {
    const double spacing = std::sqrt(2.0 / 15000);
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        INFO("seed " << seed);
        const Solid wall = in_general_pose(support::box(Vec3(1, 1, 0.6 * spacing)));
        PointCloud cloud = support::sample(
            wall, {.points = 15000, .seed = seed, .position_noise = 0.15 * spacing, .normal_noise = 0.26});
        Octree octree = build_octree(cloud);
        REQUIRE(steady_normals(octree) > 0);
        const std::vector<Vec3> given = octree.normals;
        REQUIRE(check_normals(octree).doubtful());
        REQUIRE(check_normals(octree).askew());
        CHECK(mend_normals(octree) == 0);
        CHECK(octree.normals == given);
    }
}

TEST_CASE("points without a normal are left without when the others are mended", "[normals]") {
    PointCloud cloud = with_flips(support::sphere(1), 2000, 0.1);
    for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.normals[i] = Vec3(0, 0, 0);
    Octree octree = build_octree(cloud);
    mend_normals(octree);
    std::size_t none = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        none += octree.normals[i] == Vec3(0, 0, 0);
        CHECK((octree.normals[i] | (octree.positions[i] + octree.origin)) >= 0);
    }
    CHECK(none == 200);
}

TEST_CASE("sides are in doubt where neighbours on one plane face opposite ways, and not for one stray",
          "[normals]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 6000});
    const auto doubts_of = [&](bool estimated) {
        const Octree octree = build_octree(cloud);
        Occurrences doubts = doubtful_sides(octree, check_normals(octree), estimated);
        doubts.first += octree.origin;
        return doubts;
    };
    CHECK(doubts_of(true).count == 0);
    CHECK(doubts_of(false).count == 0);
    cloud.normals[17] = -cloud.normals[17];
    CHECK(doubts_of(true).count == 0);
    cloud.normals[17] = -cloud.normals[17];
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud.positions[i][2] > 0.43) cloud.normals[i] = -cloud.normals[i]; // not between two voxels
    const Occurrences cut = doubts_of(true);
    CHECK(cut.count >= 10);
    CHECK(std::abs(cut.first[2] - 0.43) < 0.1);
    CHECK(doubts_of(false).count == cut.count);
}
