#include "hsdm/completion/free_space.hh"
#include "hsdm/octree/spacing.hh"
#include "support/scanner.hh"
#include "support/scenes.hh"

#include <catch2/catch.hpp>

#include <tbb/global_control.h>

#include <algorithm>

using namespace hsdm;
using namespace hsdm::support;

namespace {

struct Seen {
    PointCloud cloud;
    Octree octree;
    Viewpoints viewpoints;
    double voxel_size;

    explicit Seen(PointCloud scan) : cloud(std::move(scan)), octree(build_octree(cloud)) {
        for (const Vec3& sensor : cloud.sensors) viewpoints.sensors.push_back(sensor - octree.origin);
        viewpoints.sensor_of = view_of(cloud).sensor_of;
        voxel_size = 3 * estimate_spacing(octree);
    }
    FreeSpace space() const { return {octree, viewpoints, voxel_size}; }
};

} // namespace

TEST_CASE("nothing of what scanners saw exactly is free, and most of what they looked through is",
          "[completion]") {
    for (std::uint64_t seed = 10; seed < 15; ++seed) {
        const Scene seen = scene(seed);
        INFO(seen.name << ", seed " << seed);
        const Seen scan(scan_from_above(seen.solid, seen.radius, {.points = 30000, .seed = seed}));
        const FreeSpace space = scan.space();
        Random random(seed);
        std::size_t wrong = 0, inside = 0;
        for (int i = 0; i < 200000; ++i) {
            const Vec3 p =
                Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * seen.radius;
            if (!seen.solid.contains(p)) continue;
            ++inside;
            wrong += space.holds(p - scan.octree.origin);
        }
        CHECK(inside > 3000);
        CHECK(wrong == 0);
        std::size_t free = 0;
        for (int i = 0; i < 10000; ++i) { // places on rays
            const std::size_t k = random.below(scan.cloud.size());
            const Vec3& from = scan.cloud.sensors[static_cast<std::size_t>(scan.cloud.sensor_of[k])];
            const double before = random.uniform(4, 20) * scan.voxel_size;
            const Vec3 way = scan.cloud.positions[k] - from;
            free += space.holds(scan.cloud.positions[k] - way * (before / way.norm()) - scan.octree.origin);
        }
        CHECK(free > 7500);
    }
}

TEST_CASE("behind what one saw, and where nobody looked, no place is free", "[completion]") {
    PointCloud cloud;
    Random random(5);
    cloud.sensors = {Vec3(0.1, 0.2, 10)};
    for (int i = 0; i < 20000; ++i)
        cloud.positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    const Seen scan(std::move(cloud));
    const FreeSpace space = scan.space();
    const double h = scan.voxel_size;
    std::size_t above = 0, free = 0;
    for (int i = 0; i < 2000; ++i) {
        const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.8, 0.8), z = random.uniform(-1, 1);
        INFO(x << " " << y << " " << z);
        const bool is_free = space.holds(Vec3(x, y, z) - scan.octree.origin);
        if (z < 2 * h) CHECK(!is_free);
        above += z > 3 * h, free += is_free;
        CHECK(!space.holds(Vec3(x + 3, y, z) - scan.octree.origin));
    }
    CHECK(above > 700);
    CHECK(static_cast<double>(free) > 0.98 * static_cast<double>(above)); // a few bins have no two points
}

TEST_CASE("without scanners nothing is free", "[completion]") {
    Seen scan(scan_from_above(sphere(1), 1.05, {.points = 5000}));
    CHECK(!scan.space().empty());
    CHECK(FreeSpace().empty());
    CHECK(!FreeSpace().holds(Vec3(0, 0, 0)));
    CHECK(FreeSpace(scan.octree, {}, scan.voxel_size).empty());
    std::ranges::fill(scan.cloud.sensor_of, -1);
    CHECK(scan.space().empty());
}

TEST_CASE("what is free depends neither on the order of the points nor on the number of threads",
          "[completion]") {
    const Scene seen = scene(3);
    const Seen scan(scan_from_above(seen.solid, seen.radius, {.points = 20000}));
    PointCloud turned = scan.cloud;
    std::ranges::reverse(turned.positions);
    std::ranges::reverse(turned.sensor_of);
    const FreeSpace space = scan.space();
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const Seen again(std::move(turned));
    const FreeSpace other = again.space();
    Random random(1);
    std::size_t free = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p(random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3));
        free += space.holds(p);
        CHECK(space.holds(p) == other.holds(p));
    }
    CHECK(free > 1000);
}
