#include "support/dense_solid.hh"
#include "support/trial.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

DenseSolid dense(const Solid& solid, double step) {
    return {solid, Box{Vec3(-2, -2, -2), Vec3(2, 2, 2)}, step};
}

} // namespace

TEST_CASE("a dense evaluation finds the Euler characteristic of solids of known genus", "[support]") {
    Random random(3);
    const Pose pose = random_pose(random, 0.2);
    const Pose aside = turned(Vec3(1, 0, 0), 0, Vec3(0.7, 0, 0));
    const std::vector<std::pair<Solid, long>> examples = {
        {sphere(1), 2},
        {torus(1, 0.4), 0},
        {box(Vec3(1, 1.3, 0.8)), 2},
        {cylinder(0.6, 1.2) - cylinder(0.4, 2), 0},
        {nested_spheres(1, 0.7), 4},
        {mechanical_part(), -4},
        {box(Vec3(0.5, 0.5, 0.5)) | box(Vec3(0.5, 0.5, 0.5)).placed(aside), 4},
    };
    for (const auto& [solid, euler] : examples)
        for (double step : {0.08, 0.05}) {
            CHECK(dense(solid, step).surface_euler() == euler);
            CHECK(dense(solid.placed(pose), step).surface_euler() == euler);
        }
}

TEST_CASE("growing closes a gap and shrinking breaks a neck once they reach half its width", "[support]") {
    const Pose aside = turned(Vec3(1, 2, 0), 0.4, Vec3(0.7, 0, 0));
    const Solid apart = sphere(0.3) | sphere(0.2).placed(aside); // 0.2 apart
    CHECK(dense(apart, 0.03).grown(0.08).surface_euler() == 4);
    CHECK(dense(apart, 0.03).grown(0.12).surface_euler() == 2);
    const Solid dumbbell =
        sphere(0.5) | sphere(0.5).placed(turned(Vec3(1, 0, 0), 0, Vec3(1.2, 0, 0))) | box(Vec3(2, 0.2, 0.2));
    CHECK(dense(dumbbell, 0.03).surface_euler() == 2);
    CHECK(dense(dumbbell, 0.03).grown(-0.08).surface_euler() == 2);
    CHECK(dense(dumbbell, 0.03).grown(-0.12).surface_euler() == 4);
}

TEST_CASE("the sides of a wall face each other, those of an edge only if it is sharp", "[support]") {
    const auto facing = [](const Solid& solid, double limit) {
        return least_facing_distance(solid, sample(solid), limit, 0.524);
    };
    CHECK(facing(box(Vec3(1, 1, 0.1)), 0.5) == Approx(0.1).margin(0.01));
    CHECK(facing(box(Vec3(1, 1, 1)) - box(Vec3(2, 2, 0.2)), 0.3) == Approx(0.2).margin(0.01));
    CHECK(facing(nested_spheres(1, 0.9), 0.5) == Approx(0.1).margin(0.01));
    CHECK(facing(box(Vec3(1, 1, 1)), 0.5) == 0.5);
    CHECK(facing(wedge(0.7, 1, 1), 0.2) == 0.2);
    CHECK(facing(wedge(0.35, 1, 1), 0.2) < 0.05);
}

TEST_CASE("a trial says how large its features are and repeats itself", "[support][slow]") {
    TrialOptions sparse;
    sparse.points_per_voxel = 1;
    std::array<int, 3> of_size{0, 0, 0};
    for (std::uint64_t seed : {2u, 3u, 11u, 13u})
        ++of_size[static_cast<std::size_t>(make_trial(seed, sparse).size)];
    for (int count : of_size) CHECK(count > 0);
    CHECK(make_trial(11, sparse).cloud.positions == make_trial(11, sparse).cloud.positions);
    sparse.thinnest = 0.3, sparse.thickest = 1;
    CHECK(make_trial(2, sparse).size == FeatureSize::thin);
}
