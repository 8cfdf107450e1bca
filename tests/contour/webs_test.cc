#include "contour/stages.hh"

#include "hsdm/contour/webs.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double edge_of_voxel = 1.0 / 16;

/// A wall on a base, or a slot in a block, of this many voxels; eight points to a squared voxel.
PointCloud wall_scan(double voxels, std::uint64_t seed) {
    const Solid wall =
        box({2, 1, 0.3}) | box({voxels * edge_of_voxel, 0.8, 0.8}).placed(turned({0, 0, 1}, 0, {0, 0, 0.4}));
    return sample(wall.placed(random_pose(seed)), {.points = 18000, .seed = seed});
}

PointCloud slot_scan(double voxels, std::uint64_t seed) {
    const Solid slot =
        box({2, 1, 0.8}) - box({voxels * edge_of_voxel, 2, 0.8}).placed(turned({0, 0, 1}, 0, {0, 0, 0.4}));
    return sample(slot.placed(random_pose(seed)), {.points = 20000, .seed = seed});
}

/// Two boxes with a gap between them.
PointCloud gap_scan(double voxels, std::uint64_t seed) {
    const double away = 0.5 + 0.5 * voxels * edge_of_voxel;
    const Solid boxes = box({1, 1, 0.5}).placed(turned({0, 0, 1}, 0, {-away, 0, 0}))
                        | box({1, 1, 0.5}).placed(turned({0, 0, 1}, 0, {away, 0, 0}));
    return sample(boxes.placed(random_pose(seed)), {.points = 16000, .seed = seed});
}

/// Rows opened one round after the other, each of which must leave two chains more and nothing else.
std::size_t opened_by_twos(Stages& stages) {
    const auto chains = [&] { return stages.duals.size() - stages.duals.after_cut.size(); };
    std::size_t opened = 0;
    for (int round = 0; round < 100; ++round) {
        const std::size_t before = chains(), open = open_sides(stages.links);
        const std::size_t rows = open_webs(stages.crossings, stages.duals, stages.links);
        if (rows == 0) return opened;
        opened += rows;
        stages.duals =
            build_dual_vertices(stages.grid, stages.crossings, stages.sets, stages.h(), stages.links);
        CHECK(chains() == before + 2 * rows);
        CHECK(open_sides(stages.links) == open);
    }
    FAIL("no end");
    return opened;
}

} // namespace

TEST_CASE("a web that is opened leaves two vertices more, whatever the normals, and none is left",
          "[contour]") {
    for (const std::uint64_t seed : {7u, 8u, 9u}) {
        Stages noise(random_cloud(3000, seed), 4);
        CHECK(opened_by_twos(noise) > 0);
    }
    Stages wall(wall_scan(0.4, 3), 5); // no patches here: webs enough
    CHECK(opened_by_twos(wall) > 0);
    for (const auto& sides : wall.links.of_crossing)
        for (const Link& link : sides)
            if (!link.open()) CHECK(wall.links.of(link.twin).rim == link.rim);
}

TEST_CASE("parts without walls or gaps have no webs", "[contour]") {
    Stages part(box({1, 0.9, 0.8}) - box({0.4, 0.4, 1}), 20000, 5);
    CHECK(open_webs(part.crossings, part.duals, part.links) == 0);
}

TEST_CASE("walls, slots and gaps of 0.4 voxels and more have the topology of the solid in any pose",
          "[contour][accuracy]") {
    for (const std::uint64_t seed : {1u, 2u, 3u})
        for (const double width : {0.4, 0.7}) {
            const auto check = [&](const char* what, const PointCloud& cloud, std::size_t components) {
                INFO(what << " of " << width << ", seed " << seed);
                const Reconstruction part = reconstruct(cloud, {.voxel_size = edge_of_voxel});
                CHECK(faults(to_polygons(part.mesh)).empty());
                CHECK(part.report.mesh.closed);
                CHECK(part.report.mesh.components == components);
                CHECK(part.report.mesh.euler == 2 * static_cast<long>(components));
            };
            check("a wall", wall_scan(width, seed), 1);
            check("a slot", slot_scan(width, seed), 1);
            check("a gap", gap_scan(width, seed), 2);
        }
}
