#include "contour/stages.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using support::Stages;

namespace {

/// A plate thinner than its voxels, so that chains round its rim are cut.
Stages plate_stages() {
    return {support::box({1, 1, 0.02}).placed(support::turned(Vec3(1, 2, 3), 0.4)), 5000, 3};
}

Vec3 outward(const Stages& stages, Index v) {
    Vec3 sum(0, 0, 0);
    for (FacetCorner corner : stages.duals.corners_of(v)) sum += stages.crossings.of(corner).normal;
    return sum.normalized();
}

} // namespace

TEST_CASE("sides that end on one point move apart, each along its own normal", "[contour]") {
    const Stages stages = plate_stages();
    const std::vector<Index>& after_cut = stages.duals.after_cut;
    REQUIRE(after_cut.size() > 10);
    std::vector<Vec3> positions = stages.vertices.positions;
    for (Index v : after_cut) positions[v] = positions[v - 1];
    const std::vector<Vec3> before = positions;
    separate_sides(stages, positions);
    std::vector<std::uint8_t> beside_cut(positions.size(), 0);
    for (Index v : after_cut) beside_cut[v - 1] = beside_cut[v] = 1;
    for (Index v = 0; v < positions.size(); ++v) {
        const Vec3 way = positions[v] - before[v];
        CHECK((way.norm() > 0) == (beside_cut[v] != 0));
        CHECK((way % outward(stages, v)).norm() < 1e-12);
        CHECK((way | outward(stages, v)) >= 0);
        CHECK(way.norm() < 0.1 * stages.h());
    }
    for (Index v : after_cut) CHECK((positions[v] - positions[v - 1]).norm() > 1e-4 * stages.h());
}

TEST_CASE("sides that lie apart stay where they are", "[contour]") {
    const Stages stages = plate_stages();
    std::vector<Vec3> positions = stages.vertices.positions;
    for (Index v : stages.duals.after_cut)
        positions[v] = positions[v - 1] + outward(stages, v) * (0.2 * stages.h());
    const std::vector<Vec3> before = positions;
    separate_sides(stages, positions);
    CHECK(positions == before);
}

TEST_CASE("where nothing is cut nothing moves", "[contour]") {
    const Stages stages(support::sphere(1), 5000, 3);
    std::vector<Vec3> positions(stages.duals.size(), Vec3(0, 0, 0));
    separate_sides(stages, positions);
    for (const Vec3& p : positions) CHECK(p == Vec3(0, 0, 0));
}
