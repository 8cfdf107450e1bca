#include "hsdm/normals/noise.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <numbers>

using namespace hsdm;

namespace {

double noise_of(const support::Solid& solid, std::size_t points, double noise = 0) {
    const Octree octree =
        build_octree(support::sample(solid, {.points = points, .normals = false, .position_noise = noise}));
    return estimate_noise(octree, find_neighbors(octree));
}

} // namespace

TEST_CASE("noise is told from creases, curvature and thin parts", "[normals]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 5000);
    CHECK(noise_of(support::sphere(1), 5000) < 0.01);
    CHECK(noise_of(support::box(Vec3(1, 1, 1)), 3000) < 1e-6);
    CHECK(noise_of(support::box(Vec3(1, 1, 2 * std::sqrt(2.0 / 5000))), 5000) < 1e-6);
    double last = 0.01;
    for (double sigma : {0.1, 0.2, 0.5, 1.0}) {
        const double noise = noise_of(support::sphere(1), 5000, sigma * spacing);
        CHECK(noise > last);
        last = noise;
    }
}

TEST_CASE("the deviation of noise is found whatever it is in spacings", "[normals][slow]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 20000);
    for (double sigma : {0.15, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0}) {
        const Octree octree = build_octree(support::sample(
            support::sphere(1), {.points = 20000, .normals = false, .position_noise = sigma * spacing}));
        INFO("noise of " << sigma << " spacings");
        CHECK(noise_deviation(octree, find_neighbors(octree)) == Approx(sigma * spacing).epsilon(0.25));
    }
}

TEST_CASE("clean clouds are seen through 16 neighbours, noisy ones through more", "[normals]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 5000);
    CHECK(neighbors_for_noise(noise_of(support::sphere(1), 5000)) == 16);
    CHECK(neighbors_for_noise(noise_of(support::sphere(1), 5000, 0.1 * spacing)) == 16);
    CHECK(neighbors_for_noise(noise_of(support::sphere(1), 5000, 0.5 * spacing)) == 32);
    CHECK(neighbors_for_noise(noise_of(support::sphere(1), 5000, 3 * spacing)) == 64);
}

TEST_CASE("samples of the points tell the deviation that all of them tell", "[normals]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 5000);
    const double sigma = GENERATE(0.0, 0.2, 3.0);
    const Octree octree = build_octree(support::sample(
        support::sphere(1), {.points = 5000, .normals = false, .position_noise = sigma * spacing}));
    const Neighbors all = find_neighbors(octree);
    std::vector<Index> points;
    for (std::size_t i = 0; i < octree.size(); i += noise_stride(octree.size()))
        points.push_back(static_cast<Index>(i));
    const NeighborOptions options{.finest_level = finest_leaves(count_leaves(octree.codes))};
    const auto samples = noise_samples(octree, points, find_neighbors_of(octree, points, options));
    const std::optional<double> told = noise_deviation(samples, octree.size());
    CHECK(told.has_value() == (sigma < 1)); // beyond, a thinned cloud tells
    if (told) CHECK(*told == noise_deviation(octree, all));
    const auto of_six = noise_samples(octree, all);
    CHECK(noise_deviation(octree, all, of_six) == noise_deviation(octree, all));
    CHECK(estimate_noise(of_six) == estimate_noise(samples));
}
