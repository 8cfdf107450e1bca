#include "hsdm/normals/steady_normals.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;
using support::in_general_pose;
using support::Solid;

namespace {

constexpr double one_degree = 0.0174532925;

/// Mean angle in one_degrees between the normals of an octree and those of the clean cloud whose points these
/// are.
double mean_error(const Octree& octree, const Octree& clean) {
    REQUIRE(octree.positions == clean.positions);
    double sum = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        sum += std::acos(std::clamp(octree.normals[i] | clean.normals[i], -1.0, 1.0));
    return sum / static_cast<double>(octree.size()) / one_degree;
}

std::vector<Solid> solids() {
    return {support::sphere(1), in_general_pose(support::torus(1, 0.4)),
            in_general_pose(support::box(Vec3(1, 1, 1))), support::mechanical_part()};
}

} // namespace

TEST_CASE("clean normals and slightly noisy ones do not count as scattered", "[normals]") {
    for (const Solid& solid : solids())
        for (const double noise : {0.0, 3 * one_degree})
            CHECK_FALSE(
                are_scattered(build_octree(support::sample(solid, {.points = 5000, .normal_noise = noise}))));
    CHECK_FALSE(
        are_scattered(build_octree(support::sample(support::sphere(1), {.points = 100, .normals = false}))));
}

TEST_CASE("noisy normals of clean points take the axes of the points and keep their sides", "[normals]") {
    for (const Solid& solid : solids()) {
        PointCloud cloud = support::sample(solid, {.points = 10000});
        const Octree clean = build_octree(cloud);
        support::Random random(5);
        for (Vec3& n : cloud.normals) n = (n + random.gauss3() * (20 * one_degree)).normalized();
        Octree noisy = build_octree(cloud);
        REQUIRE(are_scattered(noisy));
        const double before = mean_error(noisy, clean);
        CHECK(static_cast<double>(steady_normals(noisy)) > 0.95 * static_cast<double>(noisy.size()));
        CHECK(mean_error(noisy, clean) < 0.15 * before);
    }
}

TEST_CASE("noisy normals stay where the positions tell none that are better", "[normals]") {
    Octree octree = build_octree(support::sample(
        support::sphere(1), {.points = 5000, .position_noise = 0.05, .normal_noise = 15 * one_degree}));
    const std::vector<Vec3> before = octree.normals;
    CHECK(steady_normals(octree) == 0);
    CHECK(octree.normals == before);
}

TEST_CASE("a part with noisy normals comes out like the one with clean ones", "[normals]") {
    const Solid solid = in_general_pose(support::mechanical_part());
    const auto run = [&](double noise) {
        return reconstruct(support::sample(solid, {.points = 20000, .normal_noise = noise}), {.depth = 5})
            .report;
    };
    const Report clean = run(0), noisy = run(20 * one_degree);
    CHECK(clean.rejected.at("normals_steadied") == 0);
    CHECK(noisy.rejected.at("normals_steadied") > 0);
    CHECK(noisy.mesh.closed);
    CHECK(noisy.mesh.euler == clean.mesh.euler);
    CHECK(noisy.error.points_to_mesh_mean < 2 * clean.error.points_to_mesh_mean);
}

TEST_CASE("outliers beside a thin plate with noisy normals make no part of their own", "[normals]") {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        INFO("seed " << seed);
        const Solid plate = in_general_pose(support::box(Vec3(1, 1, 0.05)));
        const Report report = reconstruct(support::sample(plate, {.points = 40000,
                                                                  .seed = seed,
                                                                  .position_noise = 0.001,
                                                                  .normal_noise = 12 * one_degree,
                                                                  .outliers = 0.03}),
                                          {.depth = 3})
                                  .report;
        REQUIRE(report.rejected.at("normals_steadied") > 0);
        CHECK(report.mesh.closed);
        CHECK(report.mesh.components == 1);
    }
}
