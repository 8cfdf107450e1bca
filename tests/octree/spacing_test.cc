#include "hsdm/octree/spacing.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {
Octree sphere_octree(std::size_t points) {
    return build_octree(support::sample(support::sphere(1), {.points = points}));
}
} // namespace

TEST_CASE("voxels counted in one pass agree with every extracted level", "[octree]") {
    const Octree octree = sphere_octree(3000);
    const auto counts = count_voxels(octree);
    for (int level = 0; level <= morton_levels; ++level)
        CHECK(counts[static_cast<unsigned>(level)] == extract_level(octree, level).size());
}

TEST_CASE("the spacing is the square root of the area per point", "[octree]") {
    for (std::size_t n : {2000u, 20000u, 100000u}) {
        const double expected = std::sqrt(4 * std::numbers::pi / static_cast<double>(n));
        CHECK(estimate_spacing(sphere_octree(n)) == Approx(expected).epsilon(n < 10000 ? 0.15 : 0.02));
    }
}

TEST_CASE("the chosen depth has voxels of three to six spacings", "[octree]") {
    for (std::size_t n : {500u, 5000u, 50000u}) {
        const Octree octree = sphere_octree(n);
        const double spacing = estimate_spacing(octree);
        const DepthChoice choice = choose_depth(octree, spacing);
        CHECK(octree.voxel_size(choice.depth) >= 3 * spacing);
        CHECK(octree.voxel_size(choice.depth) < 6 * spacing);
        CHECK_FALSE(choice.reason.empty());
    }
}

TEST_CASE("the chosen voxel is three spacings wide, twice the noise, or half the cube", "[octree]") {
    const Octree octree = sphere_octree(5000);
    const double spacing = estimate_spacing(octree);
    CHECK(choose_voxel(octree, spacing, 0).size == 3 * spacing);
    CHECK(choose_voxel(octree, spacing, spacing).size == 3 * spacing);
    CHECK(choose_voxel(octree, spacing, 2 * spacing).size == 4 * spacing);
    CHECK(choose_voxel(octree, octree.extent, 0).size == octree.extent / 2);
    CHECK(choose_voxel(octree, spacing, 2 * spacing).reason.find("noise") != std::string::npos);
}

TEST_CASE("a cloud of two points still gets a depth", "[octree]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(1, 2, 3)};
    const Octree octree = build_octree(cloud);
    const double spacing = estimate_spacing(octree);
    CHECK(spacing > 0);
    CHECK(choose_depth(octree, spacing).depth == 1);
}
