#include "contour/stages.hh"

#include "hsdm/contour/sheet_widths.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double cube_edge = 1.2, finest_edge = cube_edge / 32; // of the voxels at depth 5

/// A block with a row of bores, and the opposite: rods between two plates.
Solid with_bores(double diameter) {
    Solid result = box({1, 0.4, 0.4});
    for (int i = -2; i <= 2; ++i)
        result = result - cylinder(0.5 * diameter, 1).placed(turned({0, 0, 1}, 0, {0.2 * i, 0, 0}));
    return result;
}
Solid with_rods(double diameter) {
    Solid result = box({1, 0.4, 0.1}).placed(turned({0, 0, 1}, 0, {0, 0, 0.2}))
                   | box({1, 0.4, 0.1}).placed(turned({0, 0, 1}, 0, {0, 0, -0.2}));
    for (int i = -2; i <= 2; ++i)
        result = result | cylinder(0.5 * diameter, 0.35).placed(turned({0, 0, 1}, 0, {0.2 * i, 0, 0}));
    return result;
}

double share_of_cylinders(const Solid& solid) {
    const Stages stages(sample(solid.placed(random_pose(7)), {.points = 30000, .seed = 7}), 5, cube_edge);
    return static_cast<double>(count_narrow_cylinders(stages.octree, stages.level, stages.sets))
           / static_cast<double>(stages.level.size());
}

} // namespace

TEST_CASE("voxels that bores or rods under two of them wide pass are counted", "[contour]") {
    for (const double diameter : {0.8, 1.2, 1.5}) {
        INFO("diameter " << diameter);
        CHECK(share_of_cylinders(with_bores(diameter * finest_edge)) > 0.005);
        CHECK(share_of_cylinders(with_rods(diameter * finest_edge)) > 0.005);
    }
}

TEST_CASE("wide bores, thin walls, narrow slots and creases are no narrow cylinders", "[contour]") {
    CHECK(share_of_cylinders(with_bores(4 * finest_edge)) == 0);
    CHECK(share_of_cylinders(with_rods(4 * finest_edge)) == 0);
    CHECK(share_of_cylinders(box({1, 0.6, 0.5 * finest_edge})) == 0);
    CHECK(share_of_cylinders(box({1, 0.6, 0.4}) - box({0.8, finest_edge, 0.5})) == 0);
    CHECK(share_of_cylinders(box({1, finest_edge, 1.5 * finest_edge})) == 0);
}
