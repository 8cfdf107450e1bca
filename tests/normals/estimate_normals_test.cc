#include "hsdm/errors.hh"
#include "hsdm/normals/estimate_normals.hh"
#include "support/random.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <numbers>

using namespace hsdm;
using support::in_general_pose;
using support::Solid;

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Accuracy {
    double mean_degrees = 0; ///< over all points
    double off = 0;          ///< share more than 15 degrees off
};

/// Estimates the normals of a scan, refines them (not with rounds 0) and compares, whatever their sign.
Accuracy accuracy(const Solid& solid, std::size_t points, const EstimateOptions& options = {},
                  double noise = 0) {
    const Octree octree = build_octree(support::sample(solid, {.points = points, .position_noise = noise}));
    const Neighbors neighbors = find_neighbors(octree);
    EstimatedNormals estimate = estimate_normals(octree, neighbors, options);
    if (options.rounds > 0) estimate.normals = refined_normals(octree, neighbors, estimate);
    Accuracy result;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const double angle =
            std::acos(std::min(1.0, std::abs(estimate.normals[i] | octree.normals[i]))) / degree;
        result.mean_degrees += angle / static_cast<double>(octree.size());
        result.off += (angle > 15) / static_cast<double>(octree.size());
    }
    return result;
}

} // namespace

TEST_CASE("normals of curved surfaces are exact to half a degree", "[normals]") {
    CHECK(accuracy(support::sphere(1), 4000).mean_degrees < 0.2);
    CHECK(accuracy(in_general_pose(support::torus(1, 0.4)), 8000).mean_degrees < 0.5);
}

TEST_CASE("creases stay creases", "[normals]") {
    const Solid cube = in_general_pose(support::box(Vec3(1, 1, 1)));
    const Accuracy robust = accuracy(cube, 5000), plain = accuracy(cube, 5000, {.rounds = 0});
    CHECK(robust.off < 0.03); // of all points: all lie within seven spacings of a crease
    CHECK(robust.mean_degrees < 2);
    CHECK(plain.off > 0.1); // what least squares alone would do
    CHECK(accuracy(in_general_pose(support::wedge(0.5, 1, 0.6)), 8000).off < 0.03);
}

TEST_CASE("the two sides of a plate do not disturb each other's normals", "[normals]") {
    const double spacing = std::sqrt(2.0 / 8000);
    for (double thickness : {2.0, 4.0})
        CHECK(accuracy(in_general_pose(support::box(Vec3(1, 1, thickness * spacing))), 8000).off < 0.05);
}

TEST_CASE("normals of noisy points are better than those of least squares", "[normals]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 4000);
    for (const double noise : {0.15, 0.25}) {
        INFO("noise of " << noise << " spacings");
        const Accuracy robust = accuracy(support::sphere(1), 4000, {}, noise * spacing);
        const Accuracy plain = accuracy(support::sphere(1), 4000, {.rounds = 0}, noise * spacing);
        CHECK(robust.mean_degrees < 0.85 * plain.mean_degrees);
    }
}

TEST_CASE("noise between far scan lines is no curvature", "[normals]") {
    support::Random random(5);
    PointCloud cloud;
    for (int line = 0; line < 12; ++line)
        for (int i = 0; i < 150; ++i)
            cloud.positions.emplace_back(0.08 * i, line + 0.005 * random.gauss(), 0.01 * random.gauss());
    const Octree octree = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(octree);
    const EstimatedNormals plain = estimate_normals(octree, neighbors);
    const std::vector<Vec3> refined = refined_normals(octree, neighbors, plain);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        turned += std::abs(plain.normals[i] | refined[i]) < std::cos(15 * degree);
    CHECK(turned < octree.size() / 200);
}

TEST_CASE("refined normals do not depend on the sides of the others", "[normals]") {
    const Octree octree =
        build_octree(support::sample(support::mechanical_part(), {.points = 15000, .position_noise = 0.003}));
    const Neighbors neighbors = find_neighbors(octree);
    EstimatedNormals estimate = estimate_normals(octree, neighbors);
    const std::vector<Vec3> refined = refined_normals(octree, neighbors, estimate);
    support::Random random(6);
    std::vector<double> side(octree.size());
    for (std::size_t i = 0; i < octree.size(); ++i) {
        side[i] = random.uniform(0, 1) < 0.5 ? -1 : 1;
        estimate.normals[i] *= side[i];
    }
    const std::vector<Vec3> turned = refined_normals(octree, neighbors, estimate);
    std::size_t different = 0, changed = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        different += turned[i] != refined[i] * side[i];
        changed += turned[i] != estimate.normals[i];
    }
    CHECK(different == 0);
    CHECK(changed > octree.size() / 2);
}

TEST_CASE("neighbours on a line give no normal", "[normals]") {
    PointCloud cloud;
    for (int i = 0; i < 100; ++i) cloud.positions.emplace_back(0.01 * i, 0, 0);
    cloud.positions.emplace_back(0, 50, 0);
    const Octree octree = build_octree(cloud);
    const EstimatedNormals estimate = estimate_normals(octree, find_neighbors(octree));
    std::size_t none = 0;
    for (const Vec3& n : estimate.normals) {
        CHECK((n.norm() == Approx(1) || n == Vec3(0, 0, 0)));
        none += n == Vec3(0, 0, 0);
    }
    CHECK(none >= 50); // the plane through the line and the lone point is one, too
}

TEST_CASE("estimate options are held against their ranges", "[normals]") {
    const Octree octree = build_octree(support::sample(support::sphere(1), {.points = 100}));
    const Neighbors neighbors = find_neighbors(octree);
    CHECK_THROWS_AS(estimate_normals(octree, neighbors, {.least_tolerance = 0}), OptionError);
    CHECK_THROWS_AS(estimate_normals(octree, neighbors, {.noise_tolerance = -1}), OptionError);
    CHECK_THROWS_AS(estimate_normals(octree, neighbors, {.rounds = -1}), OptionError);
}
