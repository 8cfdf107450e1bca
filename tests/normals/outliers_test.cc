#include "hsdm/normals/outliers.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// Points of a sphere, the denser the lower, and strays that are the last `strays` of the cloud.
PointCloud scan(int strays) {
    PointCloud all = support::sample(support::sphere(1), {.points = 20000, .normals = false}), cloud;
    support::Random random(5);
    for (const Vec3& p : all.positions)
        if (random.uniform(0, 1) < 1 / (1 + 4 * (p[2] + 1))) cloud.positions.push_back(p);
    for (int i = 0; i < strays;) {
        const Vec3 p(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
        if (std::abs(p.norm() - 1) < 0.4) continue;
        cloud.positions.push_back(p);
        ++i;
    }
    return cloud;
}

} // namespace

TEST_CASE("strays are removed, a surface of uneven density keeps its points", "[normals]") {
    for (int strays : {0, 1, 20}) {
        INFO(strays << " strays");
        const PointCloud cloud = scan(strays);
        Octree octree = build_octree(cloud);
        const std::size_t before = octree.size();
        Neighbors neighbors = find_neighbors(octree);
        const std::size_t dropped = drop_outliers_by_distance(octree, neighbors).count;
        CHECK(dropped == static_cast<std::size_t>(strays));
        CHECK(octree.size() == before - dropped);
        CHECK(octree.codes.size() == octree.size());
        CHECK(octree.positions.size() == octree.size());
        CHECK(octree.source.size() == octree.size());
        CHECK(std::is_sorted(octree.codes.begin(), octree.codes.end()));
        for (std::size_t i = 0; i < octree.size(); ++i) {
            const Vec3 p = octree.positions[i] + octree.origin;
            CHECK(std::abs(p.norm() - 1) < 1e-9);
            CHECK((cloud.positions[octree.source[i]] - p).norm() < 1e-9);
        }
        CHECK(neighbors.index == find_neighbors(octree).index);
        CHECK(drop_outliers_by_distance(octree, neighbors).count == 0);
    }
}

namespace {

/// A unit sphere of 20,000 points, a share of them anywhere in its box.
PointCloud spoilt_sphere(double outliers) {
    return support::sample(support::sphere(1), {.points = 20000, .outliers = outliers});
}

struct Left {
    std::size_t surface = 0, strays = 0;
};

/// Strays are those farther from the sphere than three spacings; nearer ones are not told from noise.
Left count(const std::vector<Vec3>& positions, const Vec3& origin) {
    constexpr double spacing = 0.025;
    Left left;
    for (const Vec3& p : positions) {
        const double off = std::abs((p + origin).norm() - 1);
        left.surface += off < 1e-9;
        left.strays += off > 3 * spacing;
    }
    return left;
}

/// A rod of two spacings across, a wire of single points, a disc, and a sphere whose density falls to a
/// twentieth; one unit is ten spacings of the densest.
PointCloud frail_parts() {
    PointCloud cloud;
    support::Random random(9);
    const auto add = [&](const Vec3& p, const Vec3& n) {
        cloud.positions.push_back(p);
        cloud.normals.push_back(n);
    };
    for (int i = 0; i < 2500; ++i) { // 0.1 around
        const double turn = random.uniform(0, 6.283185), z = random.uniform(-20, 20);
        const Vec3 n(std::cos(turn), std::sin(turn), 0);
        add(Vec3(12, 0, z) + 0.1 * n, n);
    }
    for (int i = 0; i < 400; ++i) add(Vec3(16, 0, 0.1 * i - 20), Vec3(1, 0, 0));
    for (int i = 0; i < 8000; ++i) {
        const Vec3 p(random.uniform(-5, 5), random.uniform(-5, 5), -14);
        if (p[0] * p[0] + p[1] * p[1] < 25) add(p, Vec3(0, 0, 1));
    }
    for (int i = 0; i < 126000; ++i) {
        const Vec3 n = random.direction();
        if (random.uniform(0, 1) < 1 / (1 + 9.5 * (n[2] + 1))) add(10 * n, n);
    }
    return cloud;
}

} // namespace

TEST_CASE("strays go though they are a tenth of all points, the surface stays", "[normals]") {
    for (const double share : {0.02, 0.1}) {
        INFO(share);
        const PointCloud cloud = spoilt_sphere(share);
        const Left before = count(cloud.positions, Vec3(0, 0, 0));
        REQUIRE(static_cast<double>(before.strays) > 0.5 * share * 20000);
        Octree by_position = build_octree(cloud), by_normal = by_position;
        Neighbors neighbors = find_neighbors(by_position);
        drop_outliers_by_distance(by_position, neighbors);
        drop_outliers_by_normals(by_normal);
        for (const Octree* octree : {&by_position, &by_normal}) {
            const Left after = count(octree->positions, octree->origin);
            CHECK(after.surface + 2 >= before.surface);
            CHECK(static_cast<double>(after.strays) < 0.15 * static_cast<double>(before.strays));
            CHECK(octree->normals.size() == octree->size());
            CHECK(std::is_sorted(octree->codes.begin(), octree->codes.end()));
        }
    }
}

TEST_CASE("rods, wires, borders and sparse parts are no strays", "[normals]") {
    const PointCloud cloud = frail_parts();
    const auto fewest = cloud.size() - cloud.size() / 2000;
    Octree octree = build_octree(cloud);
    CHECK(drop_outliers_by_normals(octree).count == 0);
    Neighbors neighbors = find_neighbors(octree);
    drop_outliers_by_distance(octree, neighbors);
    CHECK(octree.size() >= fewest);
    std::size_t wire = 0;
    for (const Vec3& p : octree.positions) wire += (p + octree.origin)[0] > 15;
    CHECK(wire == 400);
}

TEST_CASE("neighbours of a few points are those found among all", "[normals]") {
    const Octree octree = build_octree(spoilt_sphere(0.05));
    std::vector<Index> points;
    for (std::size_t i = 5; i < octree.size(); i += 97) points.push_back(static_cast<Index>(i));
    const Neighbors all = find_neighbors(octree), some = find_neighbors_of(octree, points);
    REQUIRE(some.reach.size() == points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto among_all = all.of(points[k]);
        std::vector<Index> a(among_all.begin(), among_all.end()), b(some.of(k).begin(), some.of(k).end());
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        CHECK(a == b);
        CHECK(all.reach[points[k]] == some.reach[k]);
    }
    CHECK(some.leaf_first.empty());
    CHECK(find_neighbors_of(octree, {}).reach.empty());
}

TEST_CASE("a cube that fits again is that of the points left", "[normals]") {
    PointCloud cloud = spoilt_sphere(0);
    const Octree clean = build_octree(cloud, {.placement = CubePlacement::centred});
    cloud.positions.emplace_back(100, 20, 3);
    cloud.normals.emplace_back(1, 0, 0);
    Octree octree = build_octree(cloud, {.placement = CubePlacement::centred});
    Neighbors neighbors = find_neighbors(octree);
    REQUIRE(drop_outliers_by_distance(octree, neighbors).count == 1);
    CHECK(fit_to_points(octree));
    CHECK_FALSE(fit_to_points(octree));
    CHECK(octree.extent == Approx(clean.extent).epsilon(1e-12));
    CHECK((octree.origin - clean.origin).norm() < 1e-12);
    CHECK(octree.source == clean.source);
}

TEST_CASE("noise as wide as the neighbourhoods makes no outliers of sparse places", "[normals]") {
    // A square of a hundred spacings, noise of one and a half, a third of the density on one half.
    support::Random random(11);
    PointCloud cloud;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 p(random.uniform(0, 100), random.uniform(0, 100), 1.5 * random.gauss());
        if (p[0] < 50 || random.uniform() < 1.0 / 3) cloud.positions.push_back(p);
    }
    Octree octree = build_octree(cloud);
    Neighbors neighbors = find_neighbors(octree);
    const std::size_t dropped = drop_outliers_by_distance(octree, neighbors).count;
    INFO("dropped " << dropped << " of " << cloud.positions.size());
    CHECK(dropped < cloud.positions.size() / 200);
}
