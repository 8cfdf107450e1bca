#include "hsdm/normals/smooth_points.hh"

#include "hsdm/errors.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace hsdm;
using support::Solid;

namespace {

constexpr std::size_t points = 8000;
const double spacing = std::sqrt(4 * std::numbers::pi / points); // of that many on a unit sphere

struct Smoothed {
    Octree octree;
    SmoothReport report;
};

Smoothed smoothed(const PointCloud& cloud) {
    Smoothed result{build_octree(cloud, {.use_normals = false}), {}};
    Neighbors neighbors = find_neighbors(result.octree);
    result.report = smooth_noise(result.octree, neighbors);
    CHECK(neighbors.reach.size() == result.octree.size());
    CHECK(std::is_sorted(result.octree.codes.begin(), result.octree.codes.end()));
    return result;
}

double mean_distance(const Solid& solid, const Octree& octree) {
    double sum = 0;
    for (const Vec3& p : octree.positions) sum += std::abs(solid.distance(p + octree.origin));
    return sum / static_cast<double>(octree.size());
}

/// Outward positive.
double mean_signed_distance(const Solid& solid, const Octree& octree) {
    double sum = 0;
    for (const Vec3& p : octree.positions) sum += solid.distance(p + octree.origin);
    return sum / static_cast<double>(octree.size());
}

} // namespace

TEST_CASE("noisy points come to lie near their surface, and the noise is what they were moved by",
          "[normals]") {
    for (double noise : {0.7, 1.5, 2.0}) {
        INFO("noise of " << noise << " spacings");
        const double sigma = noise * spacing;
        const Solid sphere = support::sphere(1);
        const Smoothed s = smoothed(support::sample(sphere, {.points = points, .position_noise = sigma}));
        CHECK(s.report.noise == Approx(sigma).epsilon(0.15));
        CHECK(mean_distance(sphere, s.octree) < 0.2 * sigma);
        CHECK(s.octree.size() + s.report.between.count == points);
        CHECK(s.report.between.count < points / 50);
    }
}

TEST_CASE("noisy points of a round surface come to lie on neither side of it", "[normals]") {
    for (double noise : {1.5, 3.0}) {
        for (const Solid& solid : {support::sphere(1), support::cylinder(0.5, 2), support::torus(1, 0.4)}) {
            const double sigma = noise * spacing;
            const Smoothed s = smoothed(support::sample(solid, {.points = points, .position_noise = sigma}));
            INFO("noise of " << noise << " spacings");
            CHECK(std::abs(mean_signed_distance(solid, s.octree)) < 0.1 * sigma);
            CHECK(mean_distance(solid, s.octree) < 0.25 * sigma);
        }
    }
}

TEST_CASE("a cloud of little noise stays as it is", "[normals]") {
    const Solid plate = support::box(Vec3(1, 1, 2.5 * std::sqrt(2.0 / points)));
    for (const Solid& solid : {support::sphere(1), support::mechanical_part(), plate}) {
        const PointCloud cloud = support::sample(solid, {.points = points, .normals = false});
        const Smoothed s = smoothed(cloud);
        CHECK(s.report.noise == 0);
        CHECK(s.report.between.count == 0);
        CHECK(s.octree.positions == build_octree(cloud).positions);
    }
}

TEST_CASE("the noisy sides of a plate stay two", "[normals][slow]") {
    const double sigma = 1.2 * std::sqrt(2.0 / points);
    for (double thickness : {7.0, 9.0}) {
        INFO("thickness of " << thickness << " times the noise");
        const Solid plate = support::box(Vec3(1, 1, thickness * sigma));
        const Smoothed s = smoothed(support::sample(plate, {.points = points, .position_noise = sigma}));
        std::size_t between = 0;
        for (const Vec3& p : s.octree.positions)
            between += std::abs((p + s.octree.origin)[2]) < 0.25 * thickness * sigma
                       && std::abs((p + s.octree.origin)[0]) < 0.4
                       && std::abs((p + s.octree.origin)[1]) < 0.4;
        CHECK(between < points / 100);
        CHECK(mean_distance(plate, s.octree) < 0.5 * sigma);
    }
}

TEST_CASE("no points stay between the sides of a wall that is as thick as their surroundings are wide",
          "[normals]") {
    const double step = std::sqrt(2.0 / points);
    for (const double noise : {0.5, 0.8})
        for (const std::uint64_t seed : {1u, 2u}) {
            const double sigma = noise * step, thickness = 8 * sigma;
            const support::Pose pose = support::random_pose(seed);
            const Solid plate = support::box(Vec3(1, 1, thickness)).placed(pose);
            const Solid middle = support::box(Vec3(0.8, 0.8, 1)).placed(pose); // without the rims
            const Smoothed s =
                smoothed(support::sample(plate, {.points = points, .seed = seed, .position_noise = sigma}));
            CHECK(s.report.noise > 0);
            double between = 0, inner = 0;
            for (const Vec3& p : s.octree.positions) {
                const Vec3 at = p + s.octree.origin;
                if (!middle.contains(at)) continue;
                ++inner;
                between += plate.distance(at) < -0.25 * thickness;
            }
            INFO(noise << " spacings of noise, pose " << seed << ": " << between << " of " << inner);
            CHECK(between < 0.01 * inner);
        }
}

TEST_CASE("points between the sides of a wall four deviations thick come to lie on either",
          "[normals][slow]") {
    constexpr std::size_t many = 3 * points;
    const double sigma = 1.1 * std::sqrt(2.0 / many), thickness = 4 * sigma;
    const Solid plate = support::box(Vec3(1, 1, thickness));
    for (std::uint64_t seed : {1u, 2u}) {
        const Smoothed s = smoothed(support::sample(
            plate, {.points = many, .seed = seed, .normals = false, .position_noise = sigma}));
        CHECK(s.report.noise < 1.4 * sigma);
        CHECK(mean_distance(plate, s.octree) < 0.5 * sigma);
        double above = 0, below = 0, inner = 0;
        for (const Vec3& p : s.octree.positions) {
            const Vec3 at = p + s.octree.origin;
            if (std::abs(at[0]) > 0.4 || std::abs(at[1]) > 0.4) continue;
            ++inner;
            above += at[2] > 0.3 * thickness, below += at[2] < -0.3 * thickness;
        }
        CHECK(above > 0.4 * inner);
        CHECK(below > 0.4 * inner);
    }
}

TEST_CASE("an open sheet stays one, whatever its noise", "[normals][slow]") {
    constexpr std::size_t many = 3000;
    const double step = std::sqrt(1.0 / many);
    for (const bool bounded : {false, true})
        for (std::uint32_t seed : {1u, 2u, 3u}) {
            std::mt19937 random(seed);
            const auto unit = [&] { return static_cast<double>(random()) / std::mt19937::max(); };
            PointCloud sheet;
            for (std::size_t i = 0; i < many; ++i) {
                double height = bounded ? 2 * std::sqrt(3.0) * (unit() - 0.5) : -6;
                for (int k = 0; k < 12 && !bounded; ++k) height += unit(); // nearly normal
                sheet.positions.emplace_back(unit(), unit(), 0.8 * step * height);
            }
            const Smoothed s = smoothed(sheet);
            double squares = 0;
            for (const Vec3& p : s.octree.positions) squares += std::pow((p + s.octree.origin)[2], 2);
            INFO((bounded ? "bounded noise, seed " : "normal noise, seed ") << seed);
            CHECK(s.report.noise > 0);
            CHECK(std::sqrt(squares / many) < 0.3 * 0.8 * step);
        }
}

TEST_CASE("layers of a closed surface stay one", "[normals][slow]") {
    const double sigma = 1.1 * spacing;
    PointCloud ball;
    for (const double offset : {-2.0, 2.0})
        for (const Vec3& p :
             support::sample(support::sphere(1 + offset * sigma),
                             {.points = points, .seed = offset < 0 ? 1u : 2u, .position_noise = sigma})
                 .positions)
            ball.positions.push_back(p);
    CHECK(smoothed(ball).report.noise > 1.7 * sigma);
}

TEST_CASE("what becomes of noisy points does not depend on their order", "[normals]") {
    PointCloud cloud =
        support::sample(support::torus(1, 0.4), {.points = 3000, .normals = false, .position_noise = 0.05});
    const Smoothed one = smoothed(cloud);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    std::rotate(cloud.positions.begin(), cloud.positions.begin() + 1000, cloud.positions.end());
    const Smoothed other = smoothed(cloud);
    CHECK(one.report.noise > 0);
    CHECK(one.report.noise == other.report.noise);
    CHECK(one.octree.positions == other.octree.positions);
}

TEST_CASE("points keep their normals when they are moved, for noise however small", "[normals]") {
    const double sigma = 0.2 * spacing; // left alone unless it is said to be too much
    const Solid sphere = support::sphere(1);
    const PointCloud cloud = support::sample(sphere, {.points = points, .position_noise = sigma});
    Octree octree = build_octree(cloud);
    const double before = mean_distance(sphere, octree);
    Neighbors neighbors;
    const SmoothReport report = smooth_known_noise(octree, sigma, neighbors);
    CHECK(report.noise > 0);
    CHECK(mean_distance(sphere, octree) < 0.6 * before);
    CHECK(octree.size() + report.between.count == points);
    CHECK(neighbors.reach.size() == octree.size());
    REQUIRE(octree.normals.size() == octree.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        kept += (octree.normals[i] | cloud.normals[octree.source[i]]) > 1 - 1e-12;
    CHECK(kept == octree.size());
}

TEST_CASE("smoothing options out of range are refused", "[normals]") {
    Octree octree = build_octree(support::sample(support::sphere(1), {.points = 100}));
    Neighbors neighbors = find_neighbors(octree);
    CHECK_THROWS_AS(smooth_noise(octree, neighbors, {.least_noise = -1}), OptionError);
    CHECK_THROWS_AS(smooth_noise(octree, neighbors, {.most_stretch = 1}), OptionError);
    CHECK_THROWS_AS(smooth_known_noise(octree, 0.1, neighbors, {.most_stretch = 1}), OptionError);
}
