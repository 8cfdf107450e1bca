// The octree's neighbours against exact ones, which FLANN's k-d tree finds.

#include "hsdm/normals/neighbors.hh"
#include "hsdm/spatial/neighbor_search.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// Of single precision, in which the octree's candidates are ranked; their coordinates are of the order of
/// the distances.
constexpr double single_rounding = 2e-6;

struct Agreement {
    double recall = 0;  ///< share of the neighbours that are as near as the nearest so many
    double farther = 1; ///< the largest ratio of the octree's reach to the exact one
};

/// Checks what holds of any cloud, too: so many different others of each point, none nearer than there can
/// be, the reach that of the farthest of them.
Agreement compare_with_exact(const Octree& octree, int count) {
    const Neighbors found = find_neighbors(octree, {.count = count});
    const NearPoints exact = NeighborSearch(octree.positions).neighbors(count);
    Agreement agreement;
    std::size_t near = 0, repeated = 0, too_near = 0, other_reach = 0;
    for (Index i = 0; i < octree.size(); ++i) {
        std::vector<Index> others(found.of(i).begin(), found.of(i).end());
        std::ranges::sort(others);
        repeated += std::adjacent_find(others.begin(), others.end()) != others.end()
                    || std::ranges::binary_search(others, i);
        const double reach = exact.distances_of(i).back();
        double farthest = 0;
        for (const Index j : others) {
            const double distance = (octree.positions[j] - octree.positions[i]).norm();
            farthest = std::max(farthest, distance);
            near += distance <= reach * (1 + single_rounding);
        }
        too_near += farthest < reach * (1 - single_rounding);
        other_reach += !(std::abs(found.reach[i] - farthest) <= single_rounding * farthest);
        if (reach > 0) agreement.farther = std::max(agreement.farther, farthest / reach);
    }
    CHECK(repeated == 0);
    CHECK(too_near == 0);
    CHECK(other_reach == 0);
    agreement.recall = static_cast<double>(near) / static_cast<double>(found.index.size());
    UNSCOPED_INFO("recall " << agreement.recall << ", farther " << agreement.farther);
    return agreement;
}

/// Of a flat square, denser from one side to the other by a factor.
PointCloud graded_square(std::size_t points, double factor) {
    support::Random random(11);
    PointCloud cloud;
    for (std::size_t i = 0; i < points; ++i) {
        const double x = std::log1p(random.uniform() * (factor - 1)) / std::log(factor);
        cloud.positions.emplace_back(x, random.uniform(), 0);
    }
    return cloud;
}

PointCloud volume(std::size_t points) {
    support::Random random(12);
    PointCloud cloud;
    for (std::size_t i = 0; i < points; ++i)
        cloud.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
    return cloud;
}

/// Heaps on a sphere, a tenth of the points spread between them.
PointCloud heaps(std::size_t points) {
    support::Random random(13);
    PointCloud cloud;
    std::vector<Vec3> centres;
    for (int i = 0; i < 30; ++i) centres.push_back(random.direction());
    for (std::size_t i = 0; i < points; ++i) {
        Vec3 p = random.direction();
        if (i % 10 != 0) p = centres[i % centres.size()] + 0.05 * random.uniform() * p;
        cloud.positions.push_back(p.normalized());
    }
    return cloud;
}

} // namespace

TEST_CASE("on evenly sampled surfaces the octree finds the nearest points", "[normals][accuracy]") {
    support::Random random(10);
    const PointCloud torus = support::sample(support::torus(1, 0.4).placed(support::random_pose(random)),
                                             {.points = 20000, .normals = false});
    const PointCloud part = support::sample(support::mechanical_part(), {.points = 20000, .normals = false});
    for (const PointCloud* cloud : {&torus, &part})
        for (const int count : {3, 16, 32}) {
            const Agreement a = compare_with_exact(build_octree(*cloud), count);
            CHECK(a.recall > 0.999);
            CHECK(a.farther < 1.5);
        }
}

TEST_CASE("where the density varies the octree finds nearly all of the nearest points",
          "[normals][accuracy]") {
    CHECK(compare_with_exact(build_octree(graded_square(20000, 100)), 16).recall > 0.99);
    CHECK(compare_with_exact(build_octree(heaps(20000)), 16).recall > 0.99);
    CHECK(compare_with_exact(build_octree(volume(20000)), 16).recall > 0.9);
}

TEST_CASE("repeated points are the nearest of each other, by octree and k-d tree", "[normals]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 4000, .normals = false});
    const std::size_t once = cloud.size();
    for (int copy = 0; copy < 2; ++copy)
        for (std::size_t i = 0; i < once; ++i) cloud.positions.push_back(Vec3(cloud.positions[i]));
    const Octree octree = build_octree(cloud, {.merge_duplicates = false});
    REQUIRE(octree.size() == 3 * once);
    CHECK(compare_with_exact(octree, 16).recall > 0.99);
    const Neighbors found = find_neighbors(octree);
    std::size_t same = 0;
    for (Index i = 0; i < octree.size(); ++i)
        for (const Index j : found.of(i)) same += octree.positions[i] == octree.positions[j];
    CHECK(same == 2 * octree.size());
}
