#include "contour/stages.hh"
#include "hsdm/contour/bevels.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/edges.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numbers>

using namespace hsdm;
using support::Stages;

namespace {

constexpr double one_degree = std::numbers::pi / 180;
constexpr double bar_voxel = 1.0 / 12;

/// Eight points a voxel's face.
PointCloud scan_of(const support::EdgedSolid& part, std::uint64_t seed) {
    return support::sample(
        part.solid,
        {.points = static_cast<std::size_t>(8 * part.area / (bar_voxel * bar_voxel)), .seed = seed});
}

/// Marks their links.
std::size_t marked_in(Stages& stages) {
    const std::size_t marked =
        mark_bevels(stages.grid, stages.crossings, stages.sets, stages.h(), stages.links);
    stages.place();
    return marked;
}

} // namespace

TEST_CASE("a face lies between two others if it turns from both, and along their crease", "[contour]") {
    const Vec3 y(0, 1, 0), z(0, 0, 1);
    const auto tilted = [](double turn, double along) {
        return Vec3(std::sin(along * one_degree), std::cos(along * one_degree) * std::cos(turn * one_degree),
                    std::cos(along * one_degree) * std::sin(turn * one_degree));
    };
    for (const double turn : {42.0, 45.0, 48.0}) {
        CHECK(lies_between(y, tilted(turn, 0), z));
        CHECK(lies_between(z, tilted(turn, 0), y));
        CHECK(lies_between(y, tilted(turn, 20), z));
        CHECK(!lies_between(y, tilted(turn, 35), z)); // as the third face of a corner
    }
    for (const double turn : {-45.0, 0.0, 24.0, 66.0, 90.0, 135.0})
        CHECK(!lies_between(y, tilted(turn, 0), z));
    CHECK(!lies_between(y, y, y));
    CHECK(!lies_between(y, z, -y));
}

TEST_CASE("chamfers of half a voxel and more keep both edges", "[contour]") {
    for (const double turn : {45.0, 42.0, 36.0})
        for (const double width : {0.5, 0.75, 1.0})
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                INFO("turn " << turn << ", width " << width << ", seed " << seed);
                const support::EdgedSolid bar = support::placed(
                    support::chamfered_bar(width * bar_voxel, turn * one_degree), support::random_pose(seed));
                const Reconstruction result =
                    reconstruct(scan_of(bar, seed), {.voxel_size = bar_voxel, .classify = false});
                const PolygonMesh facets = to_polygons(result.mesh);
                CHECK(support::faults(facets).empty());
                CHECK(result.mesh.n_vertices() + result.mesh.n_faces() == result.mesh.n_edges() + 2);
                CHECK(support::farthest_vertex(facets, bar.solid) < 0.25 * bar_voxel);
                const support::Lines found = support::folds(result.mesh, turn / 2 * one_degree);
                const double least = turn < 40 && width < 1 ? 0.8 : 0.9;
                CHECK(support::share_near(bar.blunt, found, bar_voxel / 4) > least);
                CHECK(support::share_near(found, bar.all, bar_voxel / 4) > least);
            }
}

TEST_CASE("fillets of half a voxel and more are no edges, chamfers as wide are", "[contour]") {
    for (const double radius : {0.5, 0.75, 1.0}) {
        double fillets = 0, chamfers = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const auto marked = [&](const support::EdgedSolid& part, double tolerance) {
                const support::EdgedSolid bar = support::placed(part, support::random_pose(seed));
                const PolyMesh mesh = reconstruct(scan_of(bar, seed), {.voxel_size = bar_voxel}).mesh;
                return support::share_near(bar.blunt, support::marked(mesh), tolerance * bar_voxel) / 4;
            };
            fillets += marked(support::filleted_bar(radius * bar_voxel), 0.25 + 0.8 * radius);
            chamfers += marked(support::chamfered_bar(radius * bar_voxel, 45 * one_degree), 0.25);
        }
        INFO("radius " << radius << ": marked are " << fillets << " of fillets, " << chamfers
                       << " of chamfers");
        CHECK(fillets < (radius < 0.6 ? 0.2 : 0.1));
        CHECK(chamfers > 0.9);
    }
}

TEST_CASE("chamfers of a cavity keep both edges, whichever way axes point", "[contour]") {
    const support::EdgedSolid bar = support::chamfered_bar(0.6 * bar_voxel, 45 * one_degree);
    support::EdgedSolid hollow = bar;
    hollow.solid = support::box({1.5, 1.5, 1.5}) - bar.solid, hollow.area = 19.5;
    const support::EdgedSolid placed = support::placed(hollow, support::random_pose(4));
    PointCloud cloud = scan_of(placed, 4);
    for (const bool mirrored : {false, true}) {
        INFO((mirrored ? "mirrored" : "as it is"));
        support::Lines edges = placed.blunt;
        if (mirrored) {
            for (auto* places : {&cloud.positions, &cloud.normals})
                for (Vec3& p : *places) p = -p;
            for (support::Segment& s : edges) s = {-s.from, -s.to};
        }
        const Reconstruction result = reconstruct(cloud, {.voxel_size = bar_voxel, .classify = false});
        CHECK(support::faults(to_polygons(result.mesh)).empty());
        CHECK(result.mesh.n_vertices() + result.mesh.n_faces() == result.mesh.n_edges() + 4);
        CHECK(support::share_near(edges, support::folds(result.mesh, 22.5 * one_degree), bar_voxel / 4)
              > 0.9);
    }
}

TEST_CASE("where no face lies between two nothing is marked, and no other vertex is made", "[contour]") {
    const support::Pose pose = support::random_pose(3);
    for (const support::Solid& solid :
         {support::box({1, 0.8, 0.6}), support::sphere(0.5), support::torus(0.5, 0.2),
          support::cylinder(0.2, 1), support::torus(0.5, 0.11), support::cylinder(0.1, 1)}) {
        Stages stages(solid.placed(pose), 6000, 4);
        CHECK(marked_in(stages) == 0);
        CHECK(stages.duals.after_cut.empty());
    }
}

TEST_CASE("bevels and what is cut at them are the same under turned normals", "[contour]") {
    const support::EdgedSolid bar =
        support::placed(support::chamfered_bar(0.5 * bar_voxel, 45 * one_degree), support::random_pose(5));
    PointCloud cloud = scan_of(bar, 5);
    const auto bevels = [&] {
        Stages stages(cloud, 4);
        const std::size_t marked = marked_in(stages);
        return std::array{marked, stages.duals.size(), stages.duals.after_cut.size()};
    };
    const auto before = bevels();
    CHECK(before[0] > 20);
    CHECK(before[2] > before[0]);
    for (Vec3& n : cloud.normals) n *= -1;
    CHECK(bevels() == before);
}
