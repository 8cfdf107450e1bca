#include "hsdm/contour/normal_sets.hh"
#include "hsdm/errors.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace hsdm;

namespace {

struct Built {
    Octree octree;
    OctreeLevel level;
    NormalSets sets;
};

Built build(const PointCloud& cloud, int depth, const NormalSetOptions& options = {}) {
    Built b;
    b.octree = build_octree(cloud);
    b.level = extract_level(b.octree, depth);
    b.sets = build_normal_sets(b.octree, b.level, options);
    return b;
}

PointCloud scan_of_sets(const support::Solid& solid, std::size_t points, double normal_noise = 0) {
    return support::sample(solid, {.points = points, .normal_noise = normal_noise});
}

} // namespace

TEST_CASE("every point with a normal is in one set of its own voxel, and counts agree", "[contour]") {
    const Built b = build(scan_of_sets(support::box({1, 1, 1}), 20000), 4);
    std::vector<Index> counted(b.sets.sets.size(), 0);
    bool own_voxel = true;
    for (Index v = 0; v < b.level.size(); ++v)
        for (Index p = b.level.first_point[v]; p < b.level.first_point[v + 1]; ++p) {
            const Index set = b.sets.first[v] + b.sets.of_point[p];
            REQUIRE(set < counted.size());
            own_voxel &= b.sets.sets[set].voxel == v && set < b.sets.first[v + 1];
            ++counted[set];
        }
    CHECK(own_voxel);
    for (std::size_t s = 0; s < counted.size(); ++s) CHECK(counted[s] == b.sets.sets[s].count);
}

TEST_CASE("the faces of a box in a voxel are as many sets, each with its face's normal", "[contour]") {
    const Built b = build(scan_of_sets(support::box({1, 1, 1}), 50000), 3);
    std::size_t corners = 0;
    for (Index v = 0; v < b.level.size(); ++v) {
        const VoxelCoord c = b.level.coord(v);
        const auto outer = std::count_if(c.begin(), c.end(), [](int x) { return x == 0 || x == 7; });
        CHECK(static_cast<long>(b.sets.of_voxel(v).size()) == outer);
        corners += outer == 3;
        for (const NormalSet& set : b.sets.of_voxel(v)) CHECK(set.normal.max_abs() == Approx(1).margin(1e-9));
    }
    CHECK(corners == 8);
}

TEST_CASE("normal noise of ten degrees does not tear a plane's set apart", "[contour]") {
    const Built b = build(scan_of_sets(support::box({4, 4, 0.5}), 60000, 0.17), 3);
    std::size_t flat = 0, torn = 0;
    for (Index v = 0; v < b.level.size(); ++v) {
        const VoxelCoord c = b.level.coord(v);
        if (c[0] == 0 || c[0] == 7 || c[1] == 0 || c[1] == 7) continue; // not at the rim
        ++flat;
        std::size_t large = 0;
        for (const NormalSet& set : b.sets.of_voxel(v)) large += set.count > 10;
        torn += large > 2; // top and bottom share the voxel
    }
    CHECK(flat > 0);
    CHECK(torn == 0);
}

namespace {

/// Flat sheets over 8 x 8 voxels, each at a height that may depend on x and faces up or down.
struct Sheet {
    double left, right; ///< heights over the left and the right half of every voxel
    double up;
};

std::vector<std::size_t> sets_per_voxel(const std::vector<Sheet>& sheets, bool merge_layers) {
    PointCloud cloud;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 2000; ++i)
        for (const Sheet& sheet : sheets) {
            const double x = 8 * unit(random);
            cloud.positions.emplace_back(x, 8 * unit(random),
                                         x - std::floor(x) < 0.5 ? sheet.left : sheet.right);
            cloud.normals.emplace_back(0, 0, sheet.up);
        }
    cloud.positions.emplace_back(0, 0, 0); // so that voxels are those of the halves
    cloud.normals.emplace_back(0, 0, 1);
    cloud.positions.emplace_back(8, 8, 0.9);
    cloud.normals.emplace_back(0, 0, 1);
    const Built b = build(cloud, 3, {.merge_layers = merge_layers});
    std::vector<std::size_t> counts;
    for (Index v = 1; v + 1 < b.level.size(); ++v) counts.push_back(b.sets.of_voxel(v).size());
    return counts;
}

} // namespace

TEST_CASE("nested shells with equal normals are told apart by position", "[contour]") {
    for (std::size_t count : sets_per_voxel({{0.2, 0.2, 1}, {0.6, 0.6, 1}}, false)) CHECK(count == 2);
}

TEST_CASE("of layers to be merged, those with none between that faces back are one set", "[contour]") {
    for (std::size_t count : sets_per_voxel({{0.2, 0.2, 1}, {0.6, 0.6, 1}}, true)) CHECK(count == 1);
    for (std::size_t count : sets_per_voxel({{0.2, 0.2, 1}, {0.6, 0.6, 1}, {0.8, 0.8, -1}}, true))
        CHECK(count == 2);
    for (std::size_t count : sets_per_voxel({{0.2, 0.2, 1}, {0.4, 0.4, -1}, {0.6, 0.6, 1}}, true))
        CHECK(count == 3);
    for (std::size_t count : sets_per_voxel({{0.2, 0.2, 1}, {0.6, 0.6, -1}}, true)) CHECK(count == 2);
    // The widest gap is one of layers, a narrower one of sheets.
    for (std::size_t count :
         sets_per_voxel({{0.1, 0.1, 1}, {0.45, 0.45, 1}, {0.85, 0.85, 1}, {0.25, 0.25, -1}}, true))
        CHECK(count == 3);
}

TEST_CASE("the two levels of a step are two sets", "[contour]") {
    for (bool merge_layers : {false, true})
        for (std::size_t count : sets_per_voxel({{0.2, 0.6, 1}}, merge_layers)) CHECK(count == 2);
}

TEST_CASE("a set's centroid lies on a curved surface, not below it", "[contour]") {
    const Built b = build(scan_of_sets(support::sphere(1), 200000), 3);
    double worst = 0;
    for (const NormalSet& set : b.sets.sets)
        if (set.count > 200) worst = std::max(worst, std::abs((set.centroid + b.octree.origin).norm() - 1));
    CHECK(worst < 0.004); // the plain mean lies 0.008 below at this voxel size
}

TEST_CASE("sets do not depend on the order of the points", "[contour]") {
    PointCloud cloud = scan_of_sets(support::mechanical_part(), 20000, 0.1);
    const Built b = build(cloud, 5);
    std::vector<std::size_t> order(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937_64(7));
    PointCloud shuffled;
    for (std::size_t i : order) {
        shuffled.positions.push_back(cloud.positions[i]);
        shuffled.normals.push_back(cloud.normals[i]);
    }
    const Built s = build(shuffled, 5);
    REQUIRE(s.sets.sets.size() == b.sets.sets.size());
    for (std::size_t i = 0; i < b.sets.sets.size(); ++i) {
        CHECK(s.sets.sets[i].centroid == b.sets.sets[i].centroid);
        CHECK(s.sets.sets[i].normal == b.sets.sets[i].normal);
    }
}

TEST_CASE("options of the sets out of range are refused", "[contour]") {
    const Octree octree = build_octree(scan_of_sets(support::sphere(1), 100));
    const OctreeLevel level = extract_level(octree, 2);
    NormalSetOptions options;
    options.max_sets = 9;
    CHECK_THROWS_AS(build_normal_sets(octree, level, options), OptionError);
    options = {};
    options.cluster_angle = 0;
    CHECK_THROWS_AS(build_normal_sets(octree, level, options), OptionError);
}
