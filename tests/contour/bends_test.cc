#include "contour/stages.hh"

#include "hsdm/contour/bends.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr int finest = 5;
constexpr double bent_cube = 1.2, bent_voxel = bent_cube / (1 << finest);

NormalSets sets_of(const Solid& solid, double noise = 0) {
    const PointCloud cloud = sample(solid.placed(random_pose(3)),
                                    {.points = 40000, .seed = 3, .position_noise = noise * bent_voxel});
    return Stages(cloud, finest, bent_cube).sets;
}

double deviation(const NormalSets& sets) {
    return measure_bends(sets, bent_voxel, [](Index) { return true; }).deviation();
}

} // namespace

TEST_CASE("chords cut off a sphere what its radius and the voxels tell, and noise does not count",
          "[contour]") {
    // A patch as wide as a voxel turns by a sixth of its width over the radius, times the width.
    const double radius = 0.25, expected = bent_voxel / (6 * std::sqrt(5.0) * radius);
    CHECK(deviation(sets_of(sphere(radius))) == Approx(expected).epsilon(0.25));
    CHECK(deviation(sets_of(sphere(radius), 0.05)) == Approx(expected).epsilon(0.25));
    CHECK(deviation(sets_of(sphere(2 * radius))) == Approx(expected / 2).epsilon(0.25));
}

TEST_CASE("flat faces and their creases have no bends", "[contour]") {
    CHECK(deviation(sets_of(box({0.7, 0.5, 0.3}))) < 0.001);
}

TEST_CASE("the bends of parts add up to those of the whole", "[contour]") {
    const NormalSets sets = sets_of(torus(0.3, 0.1));
    const auto part = [&](Index rest) {
        return measure_bends(sets, bent_voxel, [rest](Index voxel) { return voxel % 3 == rest; });
    };
    const BendSums whole = measure_bends(sets, bent_voxel, [](Index) { return true; });
    CHECK(part(0).points + part(1).points + part(2).points == whole.points);
    CHECK(part(0).squares + part(1).squares + part(2).squares == whole.squares);
    CHECK(whole.points == 40000);
    CHECK(BendSums{}.deviation() == 0);
}
