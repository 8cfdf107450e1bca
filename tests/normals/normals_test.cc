#include "hsdm/normals/normals.hh"
#include "support/scanner.hh"

#include <catch2/catch.hpp>

#include <tbb/global_control.h>

#include <algorithm>
#include <numbers>

using namespace hsdm;
using support::in_general_pose;
using support::Solid;

namespace {

Octree without_normals(const PointCloud& cloud) {
    return build_octree(cloud, {.use_normals = false});
}

/// Share of points whose estimated normal lies on the wrong side.
double share_flipped(const PointCloud& cloud) {
    Octree octree = without_normals(cloud);
    make_normals(octree);
    std::size_t flipped = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        flipped += (octree.normals[i] | cloud.normals[octree.source[i]]) < 0;
    return static_cast<double>(flipped) / static_cast<double>(octree.size());
}

} // namespace

TEST_CASE("normals of closed surfaces point outward", "[normals]") {
    CHECK(share_flipped(support::sample(in_general_pose(support::torus(1, 0.4)), {.points = 5000})) == 0);
    CHECK(share_flipped(support::sample(in_general_pose(support::box(Vec3(1, 1, 1))), {.points = 5000}))
          < 0.002);
    CHECK(share_flipped(support::sample(in_general_pose(support::wedge(0.5, 1, 0.6)), {.points = 8000}))
          < 0.01);
    CHECK(share_flipped(support::sample(support::mechanical_part(), {.points = 15000})) < 0.01);
}

TEST_CASE("the normals of a shell's cavity point into the cavity", "[normals][accuracy]") {
    CHECK(share_flipped(support::sample(support::nested_spheres(1, 0.5), {.points = 10000})) == 0);
    for (double inner : {0.85, 0.9, 0.92}) // 5 to 2.5 spacings thick: here and there the space shines through
        for (std::uint64_t seed = 1; seed <= 4; ++seed)
            CHECK(share_flipped(
                      support::sample(support::nested_spheres(1, inner), {.points = 20000, .seed = seed}))
                  == 0);
}

TEST_CASE("the report says whose side only the volume told", "[normals][accuracy]") {
    const auto share_by_volume = [](const Solid& solid) {
        Octree octree = without_normals(support::sample(solid, {.points = 20000}));
        const NormalsReport report = make_normals(octree);
        return static_cast<double>(report.orientation.by_volume) / static_cast<double>(octree.size());
    };
    CHECK(share_by_volume(support::torus(1, 0.4)) == 0);
    CHECK(share_by_volume(support::nested_spheres(1, 0.95)) > 0.9); // too thin for views that agree
}

TEST_CASE("the two sides of a plate face away from each other", "[normals]") {
    const double spacing = std::sqrt(2.0 / 8000);
    for (double thickness : {2.0, 3.0, 5.0}) {
        INFO("thickness " << thickness << " spacings");
        const Solid plate = in_general_pose(support::box(Vec3(1, 1, thickness * spacing)));
        CHECK(share_flipped(support::sample(plate, {.points = 8000})) < 0.02);
    }
}

TEST_CASE("normals of noisy clouds point outward", "[normals]") {
    const double spacing = std::sqrt(4 * std::numbers::pi * std::numbers::pi * 0.4 / 8000); // of the torus
    for (double noise : {0.7, 1.5})
        CHECK(share_flipped(support::sample(in_general_pose(support::torus(1, 0.4)),
                                            {.points = 8000, .position_noise = noise * spacing}))
              < 0.005);
}

TEST_CASE("two objects are oriented each for itself", "[normals]") {
    const Solid apart = support::sphere(1) | support::box(Vec3(1, 1, 1)).placed({.shift = Vec3(5, 0, 0)});
    CHECK(share_flipped(support::sample(apart, {.points = 8000})) < 0.002);
}

TEST_CASE("an open sheet is consistent, and faces the sensor if there is one", "[normals]") {
    const PointCloud sphere = support::sample(support::sphere(1), {.points = 6000});
    PointCloud cap;
    for (const Vec3& p : sphere.positions)
        if (p[2] > 0.5) cap.positions.push_back(p);
    for (double side : {-1.0, 1.0}) {
        Octree octree = without_normals(cap);
        NormalsOptions options;
        options.orient.sensor = Vec3(0, 0, side * 10) - octree.origin;
        make_normals(octree, options);
        for (const Vec3& n : octree.normals) CHECK(n[2] * side > 0);
    }
}

TEST_CASE("normals do not depend on the order of the points, nor on the number of threads", "[normals]") {
    PointCloud cloud = support::sample(support::mechanical_part(support::turned(Vec3(1, 2, 3), 1)),
                                       {.points = 6000, .normals = false});
    Octree octree = without_normals(cloud);
    make_normals(octree);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    std::rotate(cloud.positions.begin(), cloud.positions.begin() + 1000, cloud.positions.end());
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    Octree again = without_normals(cloud);
    make_normals(again);
    CHECK(octree.positions == again.positions);
    CHECK(octree.normals == again.normals);
}

TEST_CASE("the smallest clouds get normals without complaint", "[normals]") {
    for (std::size_t n : {4u, 5u, 9u}) {
        PointCloud cloud;
        for (std::size_t i = 0; i < n; ++i)
            cloud.positions.emplace_back(static_cast<double>(i % 3), static_cast<double>(i / 3),
                                         0.1 * static_cast<double>(i % 2));
        Octree octree = without_normals(cloud);
        const NormalsReport report = make_normals(octree);
        CHECK(octree.normals.size() == n);
        CHECK(report.missing <= n);
    }
}

TEST_CASE("points face the scanners that saw them, though layers do not register", "[normals][accuracy]") {
    // Scans shifted by about a spacing each: two layers a spacing apart look like a thin shell. Those of a
    // ball cross, and the sky tells what they are; those of the flat faces of a block in part do not.
    const auto share_inward = [](const PointCloud& cloud, const support::Solid& solid,
                                 const Viewpoints& viewpoints) {
        Octree octree = without_normals(cloud);
        NormalsOptions options;
        options.orient.viewpoints = viewpoints;
        for (Vec3& sensor : options.orient.viewpoints.sensors) sensor -= octree.origin;
        make_normals(octree, options);
        std::size_t inward = 0;
        for (std::size_t i = 0; i < octree.size(); ++i) {
            const Vec3 p = octree.positions[i] + octree.origin;
            inward +=
                solid.distance(p + 0.05 * octree.normals[i]) < solid.distance(p - 0.05 * octree.normals[i]);
        }
        return static_cast<double>(inward) / static_cast<double>(octree.size());
    };
    struct Scanned {
        support::Solid solid;
        double misalignment;
        bool crosses;
    };
    for (const Scanned& scanned :
         {Scanned{support::sphere(1), 0.02, true}, Scanned{support::sphere(1), 0.05, true},
          Scanned{support::box({1.4, 1.1, 0.8}), 0.03, false}}) {
        const PointCloud cloud = support::scan_from_above(
            scanned.solid, 1.05, {.points = 30000, .noise = 0.003, .misalignment = scanned.misalignment});
        const double unknown = share_inward(cloud, scanned.solid, {});
        const double known = share_inward(cloud, scanned.solid, {cloud.sensors, view_of(cloud).sensor_of});
        INFO("inward: " << unknown << " without scanners, " << known << " with them");
        CHECK((scanned.crosses ? unknown < 0.01 : unknown > 2 * known));
        CHECK(known < 0.01); // what is left lies where layers cross in one patch
        // One scanner alone is wrong for what the others saw.
        CHECK(share_inward(cloud, scanned.solid, {{cloud.sensors[0]}, {}}) < 0.5);
    }
}

TEST_CASE("numbers of no scanner say nothing", "[normals]") {
    PointCloud cloud =
        support::sample(in_general_pose(support::torus(1, 0.4)), {.points = 5000, .normals = false});
    cloud.sensors = {Vec3(0, 0, 0)};
    cloud.sensor_of.assign(cloud.size(), -1);
    cloud.sensor_of[7] = 5;
    const Viewpoints viewpoints{cloud.sensors, view_of(cloud).sensor_of};
    CHECK(viewpoints.of(0) == nullptr);
    CHECK(viewpoints.of(7) == nullptr);
    CHECK(Viewpoints{}.of(0) == nullptr);
    Octree with = without_normals(cloud), plain = with;
    NormalsOptions options;
    options.orient.viewpoints = viewpoints;
    make_normals(with, options);
    make_normals(plain);
    CHECK(with.normals == plain.normals);
}
