#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/octree/octree.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

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
    for (std::size_t p = 0; p < octree.size(); ++p) {
        if (sets.of_point[p] == no_index)
            ++without;
        else
            ++counts[sets.of_point[p]];
    }
    CHECK(without == 5);
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
