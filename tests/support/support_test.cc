#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;
using namespace hsdm::support;

TEST_CASE("sampled points lie on the solid and their normals point out of it", "[support]") {
    Random random(7);
    const Pose pose = random_pose(random, 1);
    const std::vector<Solid> solids = {sphere(1),         torus(1, 0.4),    box(Vec3(1, 2, 0.5)),
                                       cylinder(0.5, 2),  wedge(0.5, 1, 1), nested_spheres(1, 0.7),
                                       mechanical_part(), random_solid(3)};
    for (const Solid& solid : solids) {
        const Solid placed = solid.placed(pose);
        const PointCloud cloud = sample(placed, {.points = 2000});
        double off = 0;
        int wrong_side = 0;
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            off = std::max(off, std::abs(placed.distance(cloud.positions[i])));
            const Vec3 step = cloud.normals[i] * 1e-6;
            wrong_side +=
                placed.contains(cloud.positions[i] + step) || !placed.contains(cloud.positions[i] - step);
        }
        CHECK(off < 1e-12);
        CHECK(wrong_side <= 2); // within 1e-6 of a concave edge
    }
}

TEST_CASE("a primitive's distance is the distance to its nearest surface point", "[support]") {
    for (const Solid& solid : {torus(1, 0.3), box(Vec3(1, 2, 0.5)), cylinder(0.5, 2), wedge(0.5, 1, 1)}) {
        const PointCloud surface = sample(solid, {.points = 40000});
        Random random(5);
        for (int i = 0; i < 20; ++i) {
            const Vec3 p(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
            double nearest = 1e9;
            for (const Vec3& q : surface.positions) nearest = std::min(nearest, (p - q).norm());
            CHECK(std::abs(solid.distance(p)) == Approx(nearest).margin(0.04));
        }
    }
}

TEST_CASE("sampling is even over the area: shares follow the faces of a box", "[support]") {
    const PointCloud cloud = sample(box(Vec3(1, 2, 3)), {.points = 30000});
    double on_face[3] = {0, 0, 0};
    for (const Vec3& n : cloud.normals)
        for (unsigned k = 0; k < 3; ++k) on_face[k] += std::abs(n[k]) > 0.5;
    CHECK(on_face[0] / 30000 == Approx(6.0 / 11).margin(0.01));
    CHECK(on_face[1] / 30000 == Approx(3.0 / 11).margin(0.01));
    CHECK(on_face[2] / 30000 == Approx(2.0 / 11).margin(0.01));
}

TEST_CASE("the same seed gives the same scan, another seed another", "[support]") {
    SampleOptions options;
    options.points = 500;
    options.position_noise = 0.01;
    options.normal_noise = 0.1;
    options.outliers = 0.05;
    const Solid part = mechanical_part();
    const PointCloud a = sample(part, options), b = sample(part, options);
    CHECK(a.positions == b.positions);
    CHECK(a.normals == b.normals);
    options.seed = 2;
    CHECK(sample(part, options).positions != a.positions);
}
