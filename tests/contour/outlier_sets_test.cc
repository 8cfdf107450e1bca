#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/octree/octree.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;

namespace {

/// A square sheet in the plane z = 0.5 with a few strays far from it, and one in its own voxels that faces
/// sideways.
PointCloud sheet_with_strays(int strays) {
    PointCloud cloud;
    support::Random random(3);
    for (int i = 0; i < 6000; ++i) {
        cloud.positions.emplace_back(random.uniform(0, 1), random.uniform(0, 1), 0.5);
        cloud.normals.emplace_back(0, 0, 1);
    }
    for (int i = 0; i < strays; ++i) {
        cloud.positions.emplace_back(0.1 + 0.2 * i, 0.1, 0.9);
        cloud.normals.emplace_back(0, 0, 1);
    }
    cloud.positions.emplace_back(0.53, 0.53, 0.5);
    cloud.normals.emplace_back(1, 0, 0);
    return cloud;
}

} // namespace

TEST_CASE("strays belong to no set, the surface keeps its points", "[contour]") {
    const PointCloud cloud = sheet_with_strays(4);
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 4);
    NormalSets sets = build_normal_sets(octree, level);
    const std::size_t before = sets.sets.size();
    const RelationTest related({}, level.voxel_size);
    CHECK(drop_outlier_sets(level, related, sets).count == 5);
    CHECK(sets.sets.size() == before - 5);
    REQUIRE(sets.first.size() == level.size() + 1);
    CHECK(sets.first.back() == sets.sets.size());
    std::vector<Index> counts(sets.sets.size(), 0);
    std::size_t without = 0;
    for (const std::uint8_t number : sets.of_point) without += number == NormalSets::no_set;
    CHECK(without == 5);
    for (Index s = 0; s < counts.size(); ++s) sets.for_points_of(s, level, [&](Index) { ++counts[s]; });
    for (Index v = 0; v < level.size(); ++v)
        for (Index s = sets.first[v]; s < sets.first[v + 1]; ++s) {
            CHECK(sets.sets[s].voxel == v);
            CHECK(sets.sets[s].count == counts[s]);
            CHECK(sets.sets[s].normal[2] == Approx(1));
        }
    CHECK(drop_outlier_sets(level, related, sets).count == 0);
}

TEST_CASE("a lone set of many points is a surface", "[contour]") {
    PointCloud cloud = sheet_with_strays(0);
    cloud.positions.pop_back();
    cloud.normals.pop_back();
    for (int i = 0; i < 20; ++i) {
        cloud.positions.emplace_back(0.1 + 0.001 * i, 0.1 + 0.0005 * (i % 5), 0.9);
        cloud.normals.emplace_back(0, 0, 1);
    }
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 4);
    NormalSets sets = build_normal_sets(octree, level);
    CHECK(drop_outlier_sets(level, RelationTest({}, level.voxel_size), sets).count == 0);
}

TEST_CASE("few points that face aside between the two sides of a wall are strays", "[contour]") {
    // Each faces nearly as the one before: step by step they lead from one side of the wall to the other.
    for (const double side : {1.0, -1.0}) { // a wall, or a gap
        PointCloud cloud;
        support::Random random(5);
        for (int i = 0; i < 12000; ++i) {
            const double up = i % 2 == 0 ? 1 : -1;
            cloud.positions.emplace_back(random.uniform(0, 1), random.uniform(0, 1), 0.5 + 0.015 * up);
            cloud.normals.emplace_back(0, 0, side * up);
        }
        for (const double degrees : {30.0, 60.0, 90.0, 120.0, 150.0}) {
            const double angle = degrees * std::numbers::pi / 180;
            cloud.positions.emplace_back(0.53, 0.53, 0.5);
            cloud.normals.emplace_back(std::sin(angle), 0, std::cos(angle));
        }
        const Octree octree = build_octree(cloud, {.merge_duplicates = false});
        const OctreeLevel level = extract_level(octree, 4);
        NormalSets sets = build_normal_sets(octree, level);
        CHECK(drop_outlier_sets(level, RelationTest({}, level.voxel_size), sets).count == 3);
        for (const NormalSet& set : sets.sets) CHECK(std::abs(set.normal[2]) > 0.8);
    }
}
