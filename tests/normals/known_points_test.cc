#include "hsdm/normals/estimate_normals.hh"
#include "hsdm/normals/known_points.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;

namespace {

/// The points of some voxels of a level, in the whole cloud's cube.
struct VoxelPart {
    Octree octree;
    std::vector<Index> in_whole;
};

VoxelPart voxels_of(const Octree& whole, int level, const std::function<bool(const VoxelCoord&)>& has) {
    VoxelPart part;
    part.octree.origin = whole.origin, part.octree.extent = whole.extent, part.octree.bounds = whole.bounds;
    for (Index i = 0; i < whole.size(); ++i) {
        if (!has(morton_decode(whole.codes[i] >> 3 * (morton_levels - level)))) continue;
        part.octree.codes.push_back(whole.codes[i]);
        part.octree.positions.push_back(whole.positions[i]);
        part.octree.source.push_back(i);
        part.in_whole.push_back(i);
    }
    return part;
}

} // namespace

TEST_CASE("known points of a part have the neighbours and the normals of the whole, bit for bit",
          "[normals]") {
    PointCloud cloud;
    SECTION("a part with creases, slightly noisy") {
        cloud = support::sample(
            support::in_general_pose(support::box({1, 0.7, 0.4}) - support::cylinder(0.15, 2)),
            {.points = 20000, .normals = false, .position_noise = 0.001});
    }
    SECTION("a grid, where many neighbours are equally far") {
        for (int x = 0; x < 120; ++x)
            for (int y = 0; y < 120; ++y) cloud.positions.emplace_back(x, y, x < 60 ? 0 : 60 - x);
    }
    constexpr int level = 4;
    const Octree whole = build_octree(cloud);
    const Neighbors neighbors = find_neighbors(whole);
    const EstimatedNormals estimate = estimate_normals(whole, neighbors);
    const int finest = finest_leaves(count_leaves(whole.codes));
    const auto has = [](const VoxelCoord& c) { return c[0] + c[1] < 14; };
    const auto has_around = [&](const VoxelCoord& voxel, int of_level) {
        const int side = 1 << level, up = of_level - level;
        for (int corner = 0; corner < 4; ++corner) { // the sum is greatest at one
            VoxelCoord c = voxel;
            for (unsigned k = 0; k < 2; ++k) {
                c[k] += (corner >> k & 1) != 0 ? 1 : -1;
                c[k] = up >= 0 ? c[k] >> up : ((c[k] + 1) << -up) - 1;
                c[k] = std::clamp(c[k], 0, side - 1);
            }
            if (!has(c)) return false;
        }
        return true;
    };
    const VoxelPart part = voxels_of(whole, level, has);
    REQUIRE(part.in_whole.size() < whole.size());
    const Neighbors found = find_neighbors(part.octree, {.finest_level = finest});
    const EstimatedNormals made = estimate_normals(part.octree, found, {.noise = estimate.noise});
    KnownPoints known(part.octree, found, has_around);
    std::size_t same = 0, others = 0;
    for (Index i = 0; i < part.octree.size(); ++i) {
        const auto of_part = found.of(i), of_whole = neighbors.of(part.in_whole[i]);
        const bool is_same = std::ranges::equal(of_part, of_whole, [&](Index j, Index k) {
            return part.in_whole[j] == k; // in the same order
        });
        if (known[i]) CHECK(is_same);
        same += known[i], others += !is_same;
    }
    CHECK(same > part.octree.size() / 2);
    CHECK(others > 0); // or the part shows nothing
    known.step();
    known.step(made.bent, 2 * repeats::twice);
    std::size_t normals = 0;
    for (Index i = 0; i < part.octree.size(); ++i) {
        if (!known[i]) continue;
        CHECK(made.normals[i] == estimate.normals[part.in_whole[i]]);
        CHECK(made.tolerance[i] == estimate.tolerance[part.in_whole[i]]);
        ++normals;
    }
    CHECK(normals > part.octree.size() / 4);
    CHECK(normals < same);
}
