#include "hsdm/errors.hh"
#include "hsdm/octree/octree.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <limits>
#include <random>
#include <set>

using namespace hsdm;

namespace {

PointCloud random_cloud(std::size_t n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(-3, 5);
    PointCloud cloud;
    for (std::size_t i = 0; i < n; ++i)
        cloud.positions.emplace_back(coordinate(random), coordinate(random), 0.5 * coordinate(random));
    return cloud;
}

} // namespace

TEST_CASE("Morton codes give their coordinates back and order children within parents", "[octree]") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 1000; ++i) {
        const VoxelCoord c{static_cast<int>(random() >> 43), static_cast<int>(random() >> 43),
                           static_cast<int>(random() >> 43)};
        CHECK(morton_decode(morton_encode(c)) == c);
        const VoxelCoord parent{c[0] / 2, c[1] / 2, c[2] / 2};
        CHECK(morton_encode(c) >> 3 == morton_encode(parent));
    }
}

TEST_CASE("every point lies in the voxel that holds it, at every level", "[octree]") {
    const PointCloud cloud = random_cloud(5000, 2);
    const Octree octree = build_octree(cloud);
    REQUIRE(octree.size() == cloud.size());
    for (int depth : {0, 1, 4, 9, 16}) {
        const OctreeLevel level = extract_level(octree, depth);
        CHECK(level.first_point.back() == cloud.size());
        bool inside = true, found = true;
        for (Index v = 0; v < level.size(); ++v) {
            const VoxelCoord c = level.coord(v);
            found &= level.find(c) == v && level.first_point[v] < level.first_point[v + 1];
            for (Index p = level.first_point[v]; p < level.first_point[v + 1]; ++p)
                for (unsigned k = 0; k < 3; ++k) {
                    const double x = octree.positions[p][k] / level.voxel_size,
                                 tolerance = 1e-9 * (1 << depth);
                    inside &= x >= c[k] - tolerance && x <= c[k] + 1 + tolerance;
                }
        }
        CHECK(inside);
        CHECK(found);
    }
}

TEST_CASE("a level made from a deeper one is that of the points", "[octree]") {
    const Octree octree = build_octree(random_cloud(5000, 4));
    for (int deeper : {1, 5, 21})
        for (int depth : {0, 1, 4, 5}) {
            if (depth > deeper) continue;
            const OctreeLevel one = extract_level(octree, depth),
                              other = coarser_level(extract_level(octree, deeper), depth);
            CHECK(other.depth == depth);
            CHECK(other.voxel_size == Approx(one.voxel_size));
            CHECK(other.codes == one.codes);
            CHECK(other.first_point == one.first_point);
            CHECK(other.find(one.codes.back()) == one.size() - 1);
        }
}

TEST_CASE("a coordinate without points is not found", "[octree]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(1, 1, 1)};
    const OctreeLevel level = extract_level(build_octree(cloud), 3);
    REQUIRE(level.size() == 2);
    CHECK(level.find(VoxelCoord{0, 0, 0}) == 0);
    CHECK(level.find(VoxelCoord{7, 7, 7}) == 1);
    CHECK(level.find(VoxelCoord{1, 0, 0}) == no_index);
    CHECK(level.find(VoxelCoord{-1, 0, 0}) == no_index);
    CHECK(level.find(VoxelCoord{8, 7, 7}) == no_index);
}

TEST_CASE("the octree does not depend on the order of the points or on the number of threads", "[octree]") {
    PointCloud cloud = random_cloud(300000, 3);
    for (std::size_t i = 0; i < 1000; ++i) cloud.positions[i] = cloud.positions[i + 1000]; // duplicates
    for (std::size_t i = 2000; i < 60000; ++i) cloud.positions[i] *= 1e-4;                 // crowds
    const Octree octree = build_octree(cloud);
    CHECK(octree.merged_duplicates == 1000);
    CHECK(std::is_sorted(octree.codes.begin(), octree.codes.end()));

    std::shuffle(cloud.positions.begin(), cloud.positions.end(), std::mt19937_64(4));
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const Octree shuffled = build_octree(cloud);
    CHECK(shuffled.codes == octree.codes);
    CHECK(shuffled.positions == octree.positions);
}

TEST_CASE("merged duplicates differ in position or normal, never in neither", "[octree]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)};
    cloud.normals = {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(0, 0, 1)};
    const Octree octree = build_octree(cloud);
    CHECK(octree.size() == 3);
    CHECK(octree.merged_duplicates == 1);
    CHECK(build_octree(cloud, {.merge_duplicates = false}).size() == 4);
}

TEST_CASE("clouds without extent are refused", "[octree]") {
    PointCloud cloud;
    CHECK_THROWS_AS(build_octree(cloud), Error);
    cloud.positions.assign(10, Vec3(1e7, 2, 3));
    CHECK_THROWS_AS(build_octree(cloud), Error);
    cloud.positions.push_back(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    CHECK_THROWS_AS(build_octree(cloud), Error);
}

TEST_CASE("a larger bounding cube moves no point and a smaller one is refused", "[octree]") {
    const PointCloud cloud = random_cloud(100, 5);
    OctreeOptions options;
    options.cube_extent = 16;
    const Octree octree = build_octree(cloud, options);
    CHECK(octree.voxel_size(4) == 1);
    for (std::size_t i = 0; i < octree.size(); ++i)
        CHECK((octree.positions[i] + octree.origin - cloud.positions[octree.source[i]]).norm() < 1e-12);
    options.cube_extent = 1;
    CHECK_THROWS_AS(build_octree(cloud, options), OptionError);
}

TEST_CASE("neighbour offsets are 6 faces, 12 edges, 8 corners, each once", "[octree]") {
    std::set<VoxelCoord> seen(neighbor_offsets.begin(), neighbor_offsets.end());
    CHECK(seen.size() == 26);
    for (std::size_t i = 0; i < 26; ++i) {
        const VoxelCoord& o = neighbor_offsets[i];
        CHECK(std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]) == (i < 6 ? 1 : i < 18 ? 2 : 3));
    }
}

TEST_CASE("the voxels round one are those found at its coordinates", "[octree]") {
    const Octree octree = build_octree(random_cloud(3000, 13));
    for (const int depth : {0, 1, 2, 4, 7, morton_levels}) {
        const OctreeLevel level = extract_level(octree, depth);
        for (Index v = 0; v < level.size(); ++v) {
            const VoxelCoord c = level.coord(v);
            std::vector<Index> expected, found;
            for (const VoxelCoord& o : neighbor_offsets)
                if (const Index w = level.find({c[0] + o[0], c[1] + o[1], c[2] + o[2]}); w != no_index)
                    expected.push_back(w);
            for_neighbors(level, v, [&](Index w) { found.push_back(w); });
            REQUIRE(found == expected);
        }
    }
}

TEST_CASE("a centred cube has the cloud's box in its middle and holds every point", "[octree]") {
    const PointCloud cloud = random_cloud(5000, 12);
    const Octree octree = build_octree(cloud, {.placement = CubePlacement::centred});
    const Vec3 middle = (octree.bounds.lo + octree.bounds.hi) / 2;
    CHECK((octree.origin + Vec3(1, 1, 1) * (octree.extent / 2) - middle).norm() < 1e-14);
    bool inside = true;
    for (const Vec3& p : octree.positions) inside &= p.min() >= 0 && p.max() <= octree.extent;
    CHECK(inside);
}

TEST_CASE("an octree that takes the cloud's normals is the same", "[octree]") {
    PointCloud cloud = random_cloud(3000, 5);
    cloud.normals = random_cloud(3000, 6).positions;
    for (bool use_normals : {true, false}) {
        PointCloud taken = cloud;
        const Octree kept = build_octree(cloud, {.use_normals = use_normals});
        const Octree took = build_octree_taking_normals(taken, {.use_normals = use_normals});
        CHECK(took.codes == kept.codes);
        CHECK(took.source == kept.source);
        CHECK(took.positions == kept.positions);
        CHECK(took.normals == kept.normals);
        CHECK(took.has_normals() == use_normals);
        CHECK(taken.normals.empty());
        CHECK(taken.positions == cloud.positions);
    }
}

TEST_CASE("points are put in the order of a larger cube, or at other places", "[octree]") {
    PointCloud cloud = random_cloud(3000, 7);
    cloud.normals = random_cloud(3000, 8).positions;
    Octree octree = build_octree(cloud);
    const double extent = 2 * octree.extent;
    rearrange(octree, std::move(octree.positions), extent);
    const Octree larger = build_octree(cloud, {.cube_extent = extent, .placement = CubePlacement::centred});
    CHECK(octree.origin == larger.origin);
    CHECK(octree.codes == larger.codes);
    CHECK(octree.source == larger.source);
    CHECK(octree.normals == larger.normals);
    double off = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        off = std::max(off, (octree.positions[i] - larger.positions[i]).norm());
    CHECK(off < 1e-12);

    // Turned about the cube's middle: every point with its own normal and source.
    std::vector<Vec3> turned;
    for (const Vec3& p : octree.positions) turned.push_back(Vec3(extent, extent, extent) - p);
    rearrange(octree, std::move(turned), extent);
    CHECK(std::is_sorted(octree.codes.begin(), octree.codes.end()));
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const Index source = octree.source[i];
        const Vec3 there = Vec3(extent, extent, extent) - octree.positions[i] + octree.origin;
        CHECK((there - cloud.positions[source]).norm() < 1e-12);
        CHECK((octree.normals[i] - cloud.normals[source].normalized()).norm() < 1e-12);
    }
}

TEST_CASE("a cube whose voxels are no numbers is refused", "[octree]") {
    const double most = 1.7e308, least = 1e-310;
    for (const double far : {most, least}) {
        PointCloud cloud;
        cloud.positions = {{-far, 0, 0}, {far, 0, 0}, {0, far, 0}, {0, 0, far}};
        CHECK_THROWS_WITH(build_octree(cloud), Catch::Contains("too large or too small"));
    }
}

TEST_CASE("the cube lies where it is asked to, and must hold the cloud", "[octree]") {
    PointCloud cloud;
    cloud.positions = {{1, 1, 1}, {2, 1, 1}, {1.5, 2.5, 1}};
    const Octree octree = build_octree(cloud, {.cube_extent = 4, .origin = Vec3(0, -1, 0.5)});
    CHECK(octree.origin == Vec3(0, -1, 0.5));
    CHECK(octree.extent == 4);
    for (std::size_t i = 0; i < octree.size(); ++i)
        CHECK(octree.positions[i] + octree.origin == cloud.positions[octree.source[i]]);
    CHECK_THROWS_AS(build_octree(cloud, {.cube_extent = 4, .origin = Vec3(1.1, 0, 0)}), OptionError);
    CHECK_THROWS_AS(build_octree(cloud, {.cube_extent = 2, .origin = Vec3(0, 0, 0)}), OptionError);
    CHECK_THROWS_AS(build_octree(cloud, {.cube_extent = 4, .origin = Vec3(0, std::nan(""), 0)}), OptionError);
}
