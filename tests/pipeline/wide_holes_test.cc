#include "hsdm/pipeline/warnings.hh"
#include "hsdm/reconstruct.hh"
#include "support/pose.hh"
#include "support/random.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// A point at random on a sheet of 18 x 14.
SurfacePoint of_sheet(Random& random) {
    const double x = random.uniform(-9, 9), y = random.uniform(-7, 7);
    return {{x, y, 0.3 * std::sin(0.4 * x)}, Vec3(-0.12 * std::cos(0.4 * x), 0, 1).normalized()};
}

SurfacePoint of_sphere(Random& random) {
    const Vec3 out = random.direction();
    return {6 * out, out};
}

/// Nine points to a unit of area, but for a hole round the place of the surface above or below `middle`.
PointCloud with_hole(SurfacePoint (*sample)(Random&), double area, const Vec3& middle, double radius) {
    Random random(7);
    PointCloud cloud;
    for (std::size_t i = 0; i < static_cast<std::size_t>(9 * area); ++i) {
        const SurfacePoint p = sample(random);
        if ((p.position - middle).norm() < radius) continue;
        cloud.positions.push_back(p.position);
        cloud.normals.push_back(p.normal);
    }
    return cloud;
}

Report report_of(const PointCloud& cloud, Holes holes = Holes::automatic) {
    ReconstructOptions options;
    options.voxel_size = 1;
    options.holes = holes;
    return reconstruct(cloud, options).report;
}

std::vector<Report::Warning> warnings_of_holes(const Report& report) {
    std::vector<Report::Warning> found;
    std::ranges::copy_if(report.warnings, std::back_inserter(found),
                         [](const Report::Warning& w) { return w.what == warning_of::wide_holes; });
    return found;
}

/// A sphere of nine points to a unit of area without those of an oval on it, as long and as wide as given.
PointCloud sphere_with_oval(double length, double width, std::uint64_t seed) {
    Random random(seed);
    const Pose pose = random_pose(random, 0.5);
    PointCloud cloud;
    while (cloud.size() < 14000) {
        const Vec3 out = random.direction(), at = 11 * out;
        const double x = 2 * at[0] / length, y = 2 * at[1] / width;
        if (at[2] > 0 && x * x + y * y < 1) continue;
        cloud.positions.push_back(pose.to_world(at));
        cloud.normals.push_back(pose.rotate(out));
    }
    return cloud;
}

} // namespace

TEST_CASE("a hole wider than gaps of the sampling stays open in any pose, a gap is closed", "[holes]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        INFO("pose " << seed);
        ReconstructOptions options;
        options.voxel_size = 1.7; // five spacings
        // 24 by 21 spacings, 4.7 voxels by 4.1; and 8 by 8 spacings
        const Report oval = reconstruct(sphere_with_oval(8, 7, seed), options).report;
        CHECK(oval.mesh.boundary_loops == 1);
        CHECK(oval.mesh.euler == 1);
        CHECK(reconstruct(sphere_with_oval(2.7, 2.7, seed), options).report.mesh.closed);
    }
}

TEST_CASE("a hole that is closed where points should lie is warned of if the surface stays open",
          "[warnings][holes]") {
    const Vec3 middle(2, 1, 0.3 * std::sin(0.8));
    const PointCloud sheet = with_hole(of_sheet, 18 * 14, middle, 1.6); // 72 points
    const Report report = report_of(sheet);
    REQUIRE(report.mesh.boundary_loops == 1);
    const auto said = warnings_of_holes(report);
    REQUIRE(said.size() == 1);
    CHECK(said[0].how_much == 1);
    CHECK((said[0].where - middle).norm() < 1);

    const Report kept = report_of(sheet, Holes::keep);
    CHECK(kept.mesh.boundary_loops == 2);
    CHECK(warnings_of_holes(kept).empty());
}

TEST_CASE("a gap that sampling may leave, and a hole of a surface without borders, are no doubt",
          "[warnings][holes]") {
    const Report narrow = report_of(with_hole(of_sheet, 18 * 14, {2, 1, 0.3 * std::sin(0.8)}, 0.8));
    CHECK(narrow.mesh.boundary_loops == 1);
    CHECK(warnings_of_holes(narrow).empty());
    const Report whole =
        report_of(with_hole(of_sphere, 4 * std::numbers::pi * 36, Vec3(1, 2, 3).normalized() * 6, 1.6));
    CHECK(whole.mesh.closed);
    CHECK(warnings_of_holes(whole).empty());
}
