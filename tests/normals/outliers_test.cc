#include "hsdm/normals/outliers.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;

namespace {

/// Points of a sphere, the denser the lower, and strays that are the last `strays` of the cloud.
PointCloud scan(int strays) {
    support::SampleOptions options;
    options.points = 20000;
    options.normals = false;
    PointCloud all = support::sample(support::sphere(1), options), cloud;
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
        const std::size_t dropped = drop_outliers(octree, find_neighbors(octree));
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
        CHECK(drop_outliers(octree, find_neighbors(octree)) == 0);
    }
}
