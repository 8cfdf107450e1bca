// Parts whose walls and gaps share voxels, as wholes.

#include "support/crowded_parts.hh"

#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// In voxels, the width of walls and gaps from which on a part has its topology in any pose (docs/sheets.md).
double narrowest(std::string_view part) {
    if (part == "hinge") return 2;
    return part == "comb" || part == "heat-sink" ? 1 : 0.5;
}

} // namespace

TEST_CASE("combs, honeycombs, heat sinks, hinges, tins and rolls have their topology",
          "[pipeline][accuracy]") {
    constexpr double width = 0.04;
    for (const CrowdedPart& part : crowded_parts())
        for (std::uint64_t pose = 1; pose <= 3; ++pose) {
            INFO(part.name << ", pose " << pose);
            const double wide = narrowest(part.name) > 1 ? 2 * width : width,
                         voxel = wide / narrowest(part.name);
            const Solid solid = part.of_width(wide).placed(random_pose(pose));
            const PointCloud cloud = sample(solid, {.points = 40000, .seed = pose});
            const Reconstruction result = reconstruct(cloud, {.voxel_size = voxel});
            CHECK(faults(to_polygons(result.mesh)) == "");
            CHECK(result.report.mesh.closed);
            CHECK(result.report.mesh.components == part.components);
            CHECK(result.report.mesh.euler == part.euler);
            CHECK(result.report.error.points_to_mesh_max < voxel);
        }
}

TEST_CASE("a fin of half a voxel cut by a slot as narrow is two parts, in any pose", "[pipeline]") {
    const Solid half = box({0.5, 4, 6});
    const Solid fin = half.placed({.shift = {0, -2.25, 0}}) | half.placed({.shift = {0, 2.25, 0}});
    for (std::uint64_t pose = 1; pose <= 8; ++pose) {
        INFO("pose " << pose);
        const PointCloud cloud = sample(fin.placed(random_pose(pose)), {.points = 3000, .seed = pose});
        const Reconstruction result = reconstruct(cloud, {.voxel_size = 1});
        CHECK(faults(to_polygons(result.mesh)) == "");
        CHECK(result.report.mesh.components == 2);
        CHECK(result.report.mesh.euler == 4);
    }
}

TEST_CASE("posts stay between plates thinner than a voxel, in any pose, and what they leave free",
          "[pipeline]") {
    // A ring round the foot of a post has the two sides of its plate within it, and a gap beyond.
    const auto plate = [](double thickness, double z) {
        return box({10, 8, thickness}).placed({.shift = {0, 0, z}});
    };
    const Solid post = box({1.5, 1.5, 3}); // ends within the plates: faces that coincide are not resolved
    const Solid posts = post.placed({.shift = {-2.5, -1.5, 1.7}}) | post.placed({.shift = {2.5, 2, 1.7}});
    for (const bool above_a_gap : {false, true}) {
        const double thickness = above_a_gap ? 0.5 : 0.7;
        const Solid stack = plate(thickness, 0) | plate(thickness, 3.4) | posts;
        const Solid solid = above_a_gap ? stack | plate(thickness, -1) : stack;
        for (std::uint64_t pose = 1; pose <= 8; ++pose) {
            PointCloud cloud = sample(solid.placed(random_pose(pose)),
                                      {.points = above_a_gap ? 6000u : 4000u, .seed = pose});
            for (const bool turned : {false, true}) {
                INFO("pose " << pose << (above_a_gap ? ", above a gap" : "") << (turned ? ", turned" : ""));
                if (turned)
                    for (Vec3& n : cloud.normals) n = -n;
                const Reconstruction result = reconstruct(cloud, {.voxel_size = 1});
                CHECK(faults(to_polygons(result.mesh)) == "");
                CHECK(result.report.mesh.components == (above_a_gap ? 2u : 1u));
                CHECK(result.report.mesh.euler == (above_a_gap ? 2 : 0));
            }
        }
    }
}
