#include "hsdm/octree/far_outliers.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

PointCloud sphere_cloud(std::size_t points, const Vec3& at = {0, 0, 0}, double scale = 1) {
    PointCloud cloud = support::sample(support::sphere(1), {.points = points});
    for (Vec3& p : cloud.positions) p = p * scale + at;
    return cloud;
}

PointCloud joined(PointCloud a, const PointCloud& b) {
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    return a;
}

} // namespace

TEST_CASE("points far away from all others go first, the others lose no digit", "[octree]") {
    PointCloud cloud = sphere_cloud(5000, Vec3(3, 5, 7));
    const std::size_t surface = cloud.size();
    const OctreeOptions centred{.placement = CubePlacement::centred};
    Octree octree = build_octree(cloud, centred);
    const Octree clean = octree;
    CloudFrame frame;
    CHECK(drop_far_outliers(octree, view_of(cloud), frame).count == 0);
    CHECK(octree.positions == clean.positions);
    for (int i = 0; i < 10; ++i) {
        cloud.positions.emplace_back(i % 2 ? 1e9 : -1e6, 4, std::pow(10.0, i));
        cloud.normals.emplace_back(1, 0, 0);
    }
    octree = build_octree(cloud, centred);
    const Occurrences strays = drop_far_outliers(octree, view_of(cloud), frame);
    CHECK(strays.count == 10);
    CHECK(std::find(cloud.positions.end() - 10, cloud.positions.end(), strays.first)
          != cloud.positions.end());
    REQUIRE(octree.size() == surface);
    CHECK((octree.origin - clean.origin).norm() < 1e-12);
    CHECK(octree.extent == clean.extent);
    CHECK(octree.source == clean.source);
    CHECK(std::is_sorted(octree.codes.begin(), octree.codes.end()));
    double worst = 0;
    for (std::size_t i = 0; i < surface; ++i)
        worst = std::max(worst, (octree.positions[i] - clean.positions[i]).norm());
    CHECK(worst < 1e-14);
}

TEST_CASE("a small part far from a large one is no stray, whatever strays there are beside it", "[octree]") {
    PointCloud cloud = joined(sphere_cloud(40000), sphere_cloud(400, Vec3(3e4, 2e4, 0), 0.2));
    for (int i = 0; i < 10; ++i) {
        cloud.positions.emplace_back(1e5 * i, -1e5, 5e4);
        cloud.normals.emplace_back(1, 0, 0);
    }
    Octree octree = build_octree(cloud);
    CloudFrame frame;
    CHECK(drop_far_outliers(octree, view_of(cloud), frame).count == 10);
    CHECK(octree.size() == 40400);
}

TEST_CASE("strays all over the place are no part however many they are", "[octree]") {
    PointCloud cloud = sphere_cloud(20000);
    support::Random random(1);
    for (int i = 0; i < 300; ++i) {
        cloud.positions.emplace_back(random.uniform(-1e6, 1e6), random.uniform(-1e6, 1e6),
                                     random.uniform(-1e6, 1e6));
        cloud.normals.emplace_back(1, 0, 0);
    }
    Octree octree = build_octree(cloud);
    CloudFrame frame;
    CHECK(drop_far_outliers(octree, view_of(cloud), frame).count == 300);
}

TEST_CASE("a part is told wherever the planes of the grid run through it", "[octree]") {
    for (const Vec3& at : {Vec3(8192, 0, 0), Vec3(8192, 3, 3), Vec3(-5461, 2730, 1365), Vec3(0, 0, 10000)}) {
        const PointCloud cloud = joined(sphere_cloud(40000), sphere_cloud(240, at, 0.4));
        Octree octree = build_octree(cloud, {.placement = CubePlacement::centred});
        CloudFrame frame;
        INFO(at);
        CHECK(drop_far_outliers(octree, view_of(cloud), frame).count == 0);
    }
}

TEST_CASE("a lattice is no crowd of parts, however often its points are there", "[octree]") {
    const double jitter = GENERATE(0.0, 1e-9, 1e-7);
    PointCloud cloud;
    support::Random random(3);
    for (int scan = 0; scan < 12; ++scan)
        for (const Vec3& p : sphere_cloud(3000).positions) {
            Vec3 at = p * 20;
            for (double& x : at) x = std::round(x) + random.uniform(-jitter, jitter);
            cloud.positions.push_back(at);
            cloud.normals.push_back(p + Vec3(1, 1, 1) * random.uniform(-0.1, 0.1));
        }
    Octree octree = build_octree(cloud);
    CloudFrame frame;
    CHECK(cut_empty_space(octree, view_of(cloud), frame).count == 0);
    CHECK_FALSE(frame.has_cuts());
}

TEST_CASE("a few strays between parts far from each other go, so that space can be cut", "[octree]") {
    PointCloud cloud = joined(sphere_cloud(5000), sphere_cloud(5000, Vec3(1e7, 0, 0)));
    for (int i = 0; i < 20; ++i) {
        cloud.positions.emplace_back(4e5 * i + 2e5, 1e5, 0);
        cloud.normals.emplace_back(1, 0, 0);
    }
    Octree octree = build_octree(cloud);
    CloudFrame frame;
    const Occurrences strays = cut_empty_space(octree, view_of(cloud), frame);
    CHECK(strays.count == 20);
    CHECK(strays.first[1] == Approx(1e5));
    CHECK(frame.has_cuts());
    CHECK(octree.extent < 100);
}

TEST_CASE("empty space between parts is cut until their spacing can be followed", "[octree]") {
    const double apart = GENERATE(1e6, 1e9, 1e12);
    PointCloud cloud = joined(sphere_cloud(5000), sphere_cloud(5000, Vec3(apart, apart / 3, 0)));
    CloudFrame frame;
    Octree octree = build_octree(cloud);
    cut_empty_space(octree, view_of(cloud), frame);
    INFO(apart << " apart, cube " << octree.extent);
    CHECK(frame.has_cuts());
    CHECK(octree.extent < 1000);
    CHECK(octree.voxel_size(16) < 0.02);
    double worst = 0, shift = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const Vec3& p = cloud.positions[octree.source[i]];
        worst = std::max(worst, (frame.to_cloud(octree.positions[i] + octree.origin) - p).norm());
        shift = std::max(shift, (frame.to_work(p) - octree.positions[i] - octree.origin).norm());
    }
    CHECK(worst <= 1e-15 * apart);
    CHECK(shift < 1e-9);

    const PointCloud sphere = sphere_cloud(5000);
    Octree ordinary = build_octree(sphere);
    const Octree before = ordinary;
    CloudFrame none;
    cut_empty_space(ordinary, view_of(sphere), none);
    CHECK_FALSE(none.has_cuts());
    CHECK(ordinary.positions == before.positions);
}
