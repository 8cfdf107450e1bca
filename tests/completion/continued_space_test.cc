#include "hsdm/completion/continued_space.hh"
#include "hsdm/completion/continued_walls.hh"
#include "support/meshes.hh"
#include "support/pose.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace hsdm;
using support::Pose;

namespace {

constexpr double step = 0.1;

/// A profile of radius and height turned round the z axis, outward where it leads up the outside.
PolygonMesh turned_profile(const std::vector<Vec3>& corners, const Pose& pose = {}) {
    std::vector<Vec3> profile;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const auto steps = static_cast<int>(std::ceil((corners[i + 1] - corners[i]).norm() / step));
        for (int k = 0; k < steps; ++k)
            profile.push_back(corners[i] + (corners[i + 1] - corners[i]) * (double(k) / steps));
    }
    profile.push_back(corners.back());
    constexpr Index around = 64;
    return support::quad_tube(around, static_cast<Index>(profile.size() - 1), [&](Index c, Index r) {
        const double turn = 2 * std::numbers::pi * c / around;
        return pose.to_world({profile[r][0] * std::cos(turn), profile[r][0] * std::sin(turn), profile[r][2]});
    });
}

/// A disc of radius 1.6 with a bore of radius 0.6, of whose wall 0.4 show at both ends; `slope` wider there.
PolygonMesh bored_disc(double height, double slope = 0, const Pose& pose = {}) {
    const double half = 0.5 * height, shown = std::min(0.4, 0.4 * half), end = 0.6 + slope * shown;
    return turned_profile({{0.6, 0, -half + shown},
                           {end, 0, -half},
                           {1.6, 0, -half},
                           {1.6, 0, half},
                           {end, 0, half},
                           {0.6, 0, half - shown}},
                          pose);
}

ContinuedSpace space_of(const PolygonMesh& mesh) {
    return {mesh, boundary_loops(mesh), step};
}

} // namespace

TEST_CASE("a bore of which both ends show is continued space, its disc is not", "[completion]") {
    for (const std::uint64_t seed : {1u, 2u}) {
        const Pose pose = support::random_pose(seed);
        const ContinuedSpace space = space_of(bored_disc(3, 0, pose));
        REQUIRE_FALSE(space.empty());
        for (double z = -0.75; z <= 0.75; z += 0.1)
            for (int k = 0; k < 12; ++k) {
                const Vec3 way(std::cos(0.5236 * k), std::sin(0.5236 * k), 0), up(0, 0, z);
                CHECK(space.holds(pose.to_world(up + way * 0.2)));
                for (const double r : {0.8, 1.1, 1.4}) CHECK_FALSE(space.holds(pose.to_world(up + way * r)));
            }
        CHECK_FALSE(space.holds(pose.to_world({0, 0, 40})));
    }
}

TEST_CASE("the edge of a face counts as the end of a bore whose wall shows at the other end alone",
          "[completion]") {
    for (const std::uint64_t seed : {3u, 4u}) {
        const Pose pose = support::random_pose(seed);
        const ContinuedSpace space = space_of(turned_profile(
            {{0.6, 0, -1.1}, {0.6, 0, -1.5}, {1.6, 0, -1.5}, {1.6, 0, 1.5}, {0.6, 0, 1.5}}, pose));
        REQUIRE_FALSE(space.empty());
        for (double z = -0.8; z <= 1.2; z += 0.1) {
            CHECK(space.holds(pose.to_world({0, 0, z})));
            CHECK_FALSE(space.holds(pose.to_world({1.1, 0, z})));
        }
    }
}

TEST_CASE("walls that lead apart, go on from one side or are a step long open nothing", "[completion]") {
    CHECK(space_of(bored_disc(3, 1)).empty()); // funnels of 45 degrees
    CHECK(space_of(bored_disc(0.3)).empty());
    const PolygonMesh cup =
        turned_profile({{0.6, 0, -1.5}, {1.6, 0, -1.5}, {1.6, 0, 1.5}, {1.2, 0, 1.5}, {1.2, 0, 1}});
    CHECK(space_of(cup).empty());
    CHECK(space_of(PolygonMesh()).empty());
    CHECK(ContinuedSpace().empty());
    CHECK_FALSE(ContinuedSpace().holds({0, 0, 0}));
}

TEST_CASE("walls go on where they lead, facing as they do, from both ends against each other",
          "[completion]") {
    // Upright, and askew to 30 degrees, where neither of two components of the axis is the greater by much.
    for (const double tilt : {0.0, std::numbers::pi / 6}) {
        const Pose pose = support::turned({0, 1, 0}, tilt, {0, 0, 0});
        const PolygonMesh mesh = bored_disc(3, 0, pose);
        Vec3 ways[2] = {{0, 0, 0}, {0, 0, 0}};
        const auto check = [&](const PolygonMesh& walls, Vec3& way) {
            CHECK(way == Vec3(0, 0, 0)); // one axis
            REQUIRE(walls.facet_count() > 0);
            way = (walls.positions[2] - walls.positions[1]).normalized();
            for (std::size_t f = 0; f < walls.facet_count(); ++f) {
                const auto t = walls.facet(f);
                const Vec3 p = pose.to_local(walls.positions[t[0]]), q = pose.to_local(walls.positions[t[1]]),
                           r = pose.to_local(walls.positions[t[2]]);
                const Vec3 middle = (p + q + r) / 3, normal = ((q - p) % (r - p)).normalized();
                CHECK(std::hypot(middle[0], middle[1]) == Approx(0.6).margin(0.05));
                CHECK((normal | Vec3(middle[0], middle[1], 0)) < 0);
            }
        };
        for_each_continued_wall(mesh, boundary_loops(mesh), step,
                                [&](const PolygonMesh& along, const PolygonMesh& against) {
                                    check(along, ways[0]);
                                    check(against, ways[1]);
                                });
        CHECK((ways[0] | ways[1]) == Approx(-1));
    }
}
