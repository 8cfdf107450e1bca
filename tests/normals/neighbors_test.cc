#include "hsdm/errors.hh"
#include "hsdm/normals/neighbors.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

std::vector<Index> sorted(std::span<const Index> neighbors) {
    std::vector<Index> result(neighbors.begin(), neighbors.end());
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<Index> nearest(const Octree& octree, Index point, std::size_t count) {
    std::vector<std::pair<double, Index>> others;
    for (Index i = 0; i < octree.size(); ++i)
        if (i != point) others.emplace_back((octree.positions[i] - octree.positions[point]).norm(), i);
    std::sort(others.begin(), others.end());
    std::vector<Index> result;
    for (std::size_t k = 0; k < count; ++k) result.push_back(others[k].second);
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace

TEST_CASE("neighbours on an evenly sampled surface are the nearest points", "[normals]") {
    support::Random random(3);
    const Octree octree = build_octree(support::sample(
        support::torus(1, 0.4).placed(support::random_pose(random)), {.points = 3000, .normals = false}));
    const Neighbors neighbors = find_neighbors(octree);
    REQUIRE(neighbors.count == 16);
    std::size_t missed = 0, compared = 0;
    for (Index i = 0; i < octree.size(); i += 7) {
        const std::vector<Index> found = sorted(neighbors.of(i)), expected = nearest(octree, i, 16);
        CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
        CHECK_FALSE(std::binary_search(found.begin(), found.end(), i));
        std::vector<Index> common;
        std::set_intersection(found.begin(), found.end(), expected.begin(), expected.end(),
                              std::back_inserter(common));
        missed += 16 - common.size();
        compared += 16;
        CHECK(neighbors.reach[i]
              >= (octree.positions[expected.back()] - octree.positions[i]).norm() * (1 - 1e-6));
    }
    CHECK(missed * 500 < compared); // the 27 voxels are cut off square: a few are missed at density changes
}

TEST_CASE("among points at equal distances, as on a grid, any of the nearest are neighbours", "[normals]") {
    constexpr int side = 40, border = 6;
    PointCloud cloud;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y) cloud.positions.emplace_back(x, y, 0);
    const Octree octree = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(octree);
    for (Index i = 0; i < octree.size(); ++i) {
        const Vec3& p = octree.positions[i];
        if (std::min(p[0], p[1]) < border || std::max(p[0], p[1]) > side - border) continue;
        const std::vector<Index> found = sorted(neighbors.of(i));
        CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
        // 4 neighbours at 1, 4 at sqrt 2, 4 at 2 and 4 of the 8 at sqrt 5
        double squares = 0;
        for (Index j : found) squares += (octree.positions[j] - p).sqrnorm();
        CHECK(squares == Approx(4 * (1 + 2 + 4 + 5)));
        CHECK(neighbors.reach[i] == Approx(std::sqrt(5)));
    }
}

TEST_CASE("a cloud smaller than a neighbourhood has all other points as neighbours", "[normals]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0.1), Vec3(9, 9, 9)};
    const Octree octree = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(octree);
    REQUIRE(neighbors.count == 4);
    for (Index i = 0; i < octree.size(); ++i) CHECK(sorted(neighbors.of(i)) == nearest(octree, i, 4));
    CHECK(neighbors.leaf_first == std::vector<Index>{0, 5});
}

TEST_CASE("many points in one place cost no more than others and have neighbours too", "[normals]") {
    support::Random random(5);
    PointCloud cloud;
    for (int i = 0; i < 4000; ++i) cloud.positions.push_back(random.direction() * 1e-12);
    for (int i = 0; i < 1000; ++i) cloud.positions.push_back(random.direction());
    const Octree octree = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(octree);
    for (Index i = 0; i < octree.size(); i += 50) {
        const std::vector<Index> found = sorted(neighbors.of(i));
        CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
        CHECK(found.back() < octree.size());
    }
}

TEST_CASE("equal points have neighbours, and so have points whose squared distances no float can hold",
          "[normals]") {
    support::Random random(5);
    for (double size : {1e-30, 1.0, 1e30, 1e45}) {
        PointCloud cloud;
        for (int i = 0; i < 40; ++i) cloud.positions.emplace_back(0, 0, 0);
        for (int i = 0; i < 300; ++i) cloud.positions.push_back(random.direction() * size);
        const Octree octree = build_octree(cloud, {.merge_duplicates = false});
        const Neighbors neighbors = find_neighbors(octree);
        for (Index i = 0; i < octree.size(); ++i) {
            const std::vector<Index> found = sorted(neighbors.of(i));
            CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
            CHECK(found.back() < octree.size());
            if (size >= 1 && octree.positions[i] == -octree.origin) // the nearest are those in the same place
                CHECK(std::ranges::all_of(
                    found, [&](Index j) { return octree.positions[j] == octree.positions[i]; }));
        }
    }
}

TEST_CASE("two parts too far apart for one octree cost no more than others", "[normals][slow]") {
    support::Random random(5);
    PointCloud cloud;
    for (int i = 0; i < 200000; ++i)
        cloud.positions.push_back(random.direction() + Vec3(i % 2 ? 0 : 1e9, 0, 0));
    const Octree octree = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(octree); // minutes, if each looked at all of its part
    double farthest = 0;
    for (Index i = 0; i < octree.size(); i += 50) {
        const std::vector<Index> found = sorted(neighbors.of(i));
        CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
        CHECK_FALSE(std::binary_search(found.begin(), found.end(), i));
        CHECK(found.back() < octree.size());
        farthest = std::max(farthest, neighbors.reach[i]);
    }
    CHECK(farthest < 3); // of its own part
}

TEST_CASE("the number of neighbours is held against its range", "[normals]") {
    const Octree octree =
        build_octree(support::sample(support::sphere(1), {.points = 100, .normals = false}));
    CHECK_THROWS_AS(find_neighbors(octree, {.count = 2}), OptionError);
    CHECK_THROWS_AS(find_neighbors(octree, {.count = 65}), OptionError);
    CHECK(find_neighbors(octree, {.count = 64}).count == 64);
}
