#include "contour/stages.hh"
#include "hsdm/contour/relax_vertices.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using support::Stages;

namespace {

/// A sheet that ends amid voxels of an eighth, its far side at `width`.
Stages sheet(double width) {
    Stages stages(support::flat_sheet(97, width, 0.3), 3, 1.05);
    stages.trim();
    return stages;
}

std::vector<Vec3> extended(const Stages& stages) {
    PlacedVertices vertices = stages.vertices;
    extend_borders(stages, stages.sets, vertices);
    return vertices.positions;
}

} // namespace

TEST_CASE("borders reach to where the points of their voxels end", "[contour]") {
    const double width = 0.72;
    const Stages stages = sheet(width);
    const std::vector<Vec3> after = extended(stages);
    std::size_t at_far_side = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        const Vec3 &was = stages.vertices.positions[v], &is = after[v];
        if (!stages.duals.open[v]) {
            CHECK(is == was);
            continue;
        }
        CHECK(is[2] == Approx(was[2])); // within the sheet
        const Box voxel = stages.voxel_of(stages.duals.corners_of(v)[0]);
        for (unsigned k = 0; k < 3; ++k) {
            CHECK(is[k] >= voxel.lo[k]);
            CHECK(is[k] <= voxel.hi[k]);
        }
        if (voxel.hi[1] < width || was[0] < 0.2 || was[0] > 0.8) continue;
        ++at_far_side;
        CHECK(was[1] < width - 0.2 * stages.h());
        CHECK(std::abs(is[1] - width) < 0.04 * stages.h());
    }
    CHECK(at_far_side > 3);
}

TEST_CASE("borders move straight outwards, wherever the vertices inwards lie", "[contour]") {
    Stages stages = sheet(0.72);
    for (Index v = 0; v < stages.duals.size(); ++v)
        if (!stages.duals.open[v]) stages.vertices.positions[v][0] += 0.3 * stages.h();
    const std::vector<Vec3> after = extended(stages);
    std::size_t moved = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        const Vec3 &was = stages.vertices.positions[v], way = after[v] - was;
        if (!stages.duals.open[v] || was[0] < 0.2 || was[0] > 0.8) continue;
        moved += way.norm() > 0;
        CHECK(std::abs(way[0]) < 1e-6);
        CHECK((was[1] < 0.5 ? -way[1] : way[1]) >= 0);
    }
    CHECK(moved > 5);
}

TEST_CASE("a closed surface has no border to extend", "[contour]") {
    const Stages stages(support::sphere(1), 5000, 3);
    CHECK(extended(stages) == stages.vertices.positions);
}
