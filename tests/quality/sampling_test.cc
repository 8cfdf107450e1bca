#include "hsdm/errors.hh"
#include "hsdm/quality/sampling.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

using namespace hsdm;

namespace {

/// columns x rows points of a plane, 0.5 apart.
PointCloud grid(int columns, int rows) {
    PointCloud cloud;
    for (int x = 0; x < columns; ++x)
        for (int y = 0; y < rows; ++y) cloud.positions.emplace_back(0.5 * x, 0.5 * y, 7);
    return cloud;
}

bool equal(const Sampling& a, const Sampling& b) {
    return a.spacing == b.spacing && a.nearest.p5 == b.nearest.p5 && a.nearest.median == b.nearest.median
           && a.nearest.p95 == b.nearest.p95 && a.nearest.p99 == b.nearest.p99 && a.duplicates == b.duplicates
           && a.isolated == b.isolated && a.statistical_outliers == b.statistical_outliers;
}

} // namespace

TEST_CASE("the points of a grid are a spacing from each other, and none is isolated", "[sampling]") {
    const Sampling found = measure_sampling(grid(60, 50));
    CHECK(found.nearest.p5 == 0.5);
    CHECK(found.nearest.p99 == 0.5);
    CHECK(found.spacing == Approx(0.5).epsilon(0.3));
    CHECK(found.duplicates == 0);
    CHECK(found.isolated == 0);
}

TEST_CASE("strays are isolated, whether or not one of them is far beyond the others", "[sampling]") {
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 20000, .normals = false});
    const Sampling clean = measure_sampling(cloud);
    CHECK(clean.isolated == 0);
    CHECK(clean.statistical_outliers < 0.01);
    support::Random random(3);
    for (int i = 0; i < 1000; ++i) cloud.positions.push_back(Vec3(0, 0, 3) + 2 * random.direction());
    const double share = 1000.0 / 21000;
    const Sampling strewn = measure_sampling(cloud);
    CHECK(strewn.isolated > 0.9 * share);
    CHECK(strewn.isolated < 1.01 * share);
    CHECK(strewn.nearest.median < 1.1 * clean.nearest.median);
    cloud.positions.emplace_back(1e7, 0, 0);
    const Sampling garbled = measure_sampling(cloud);
    CHECK(garbled.isolated > 0.9 * share);
    CHECK(garbled.statistical_outliers == Approx(1.0 / 21001)); // one deviation is hundreds of diagonals
}

TEST_CASE("points at one place count once, and are counted", "[sampling]") {
    PointCloud cloud = grid(40, 30);
    const Sampling single = measure_sampling(cloud);
    for (int i = 0; i < 50; ++i) cloud.positions.push_back(cloud.positions[7]);
    cloud.normals.assign(cloud.size(), Vec3(0, 0, 1));
    cloud.normals.back() = Vec3(1, 0, 0); // two normals at one place
    Sampling repeated = measure_sampling(cloud);
    CHECK(repeated.duplicates == 50);
    repeated.duplicates = 0;
    CHECK(equal(repeated, single));
}

TEST_CASE("a cloud of one place has no density", "[sampling]") {
    PointCloud cloud;
    CHECK(equal(measure_sampling(cloud), Sampling()));
    cloud.positions.assign(4, Vec3(1e9, 0.1, 0));
    Sampling found = measure_sampling(cloud);
    CHECK(found.duplicates == 3);
    found.duplicates = 0;
    CHECK(equal(found, Sampling()));
    cloud.positions.emplace_back(1e9, 0.1, 2);
    CHECK(measure_sampling(cloud).nearest.median == 2);
}

TEST_CASE("a sampling has one measure at any scale, far from the origin and on any number of threads",
          "[sampling]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 5000, .outliers = 0.02});
    const Sampling here = measure_sampling(cloud);
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        CHECK(equal(measure_sampling(cloud), here));
    }
    PointCloud far = cloud;
    for (Vec3& p : far.positions) p += Vec3(1e6, 1e6, -1e6);
    CHECK(measure_sampling(far).nearest.median == Approx(here.nearest.median).epsilon(1e-6));
    CHECK(measure_sampling(far).isolated == here.isolated);
    const double factor = std::ldexp(1.0, GENERATE(-900, -40, 40, 900));
    for (Vec3& p : cloud.positions) p *= factor;
    const Sampling scaled = measure_sampling(cloud);
    CHECK(scaled.nearest.p95 == here.nearest.p95 * factor);
    CHECK(scaled.spacing == here.spacing * factor);
    CHECK(scaled.isolated == here.isolated);
}

TEST_CASE("of a large cloud a part is looked at, spread over all of it", "[sampling]") {
    const PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 20000, .outliers = 0.05});
    const Sampling all = measure_sampling(cloud), part = measure_sampling(cloud, {.most = 3000});
    CHECK(part.nearest.median == Approx(all.nearest.median).epsilon(0.05));
    CHECK(part.nearest.median != all.nearest.median);
    CHECK(part.isolated == Approx(all.isolated).epsilon(0.2));
    CHECK(equal(measure_sampling(cloud, {.most = std::numeric_limits<std::size_t>::max()}), all));
}

TEST_CASE("options of a sampling and broken clouds are refused", "[sampling]") {
    PointCloud cloud = grid(4, 4);
    CHECK_THROWS_AS(measure_sampling(cloud, {.neighbors = 0}), OptionError);
    CHECK_THROWS_AS(measure_sampling(cloud, {.neighbors = 65}), OptionError);
    CHECK_THROWS_AS(measure_sampling(cloud, {.isolation = 1}), OptionError);
    CHECK_THROWS_AS(measure_sampling(cloud, {.most = 0}), OptionError);
    cloud.normals.resize(3);
    CHECK_THROWS_AS(measure_sampling(cloud), Error);
    cloud.normals.clear();
    cloud.positions[2][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(measure_sampling(cloud), Error);
}
