#include "hsdm/contour/shared_corners.hh"

#include "hsdm/contour/grid_signs.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// A box and all that comes before shared_corners.
struct Found : DualMesh {
    Vec3 size;
    support::Pose pose;
    Octree octree;
    OctreeLevel level;
    std::vector<EdgeCollapse> edges;

    Found(const Vec3& box_size, std::uint64_t seed) : size(box_size) {
        support::Random random(seed);
        pose = support::random_pose(random);
        octree = build_octree(support::sample(support::box(size).placed(pose), {.points = 5000}));
        level = extract_level(octree, 4);
        const double h = voxel_size = level.voxel_size;
        const NormalSets sets = build_normal_sets(octree, level);
        const RelationTest related({}, h);
        grid = build_grid_points(level);
        LocalSheets local = group_local_sheets(grid, sets, related, h);
        extend_grid_points(grid, local, level);
        crossings = label_grid_signs(grid, local, sets, find_crossings(grid, local, sets, related, h), h);
        duals = build_dual_vertices(grid, crossings, pair_crossings(grid, crossings, sets, related));
        edges = shared_corners(*this, place_vertices(*this, sets, related));
    }

    Vec3 to_local(const Vec3& p) const { return pose.to_local(p + octree.origin); }
    /// Does a chain pass the box's top or bottom?
    bool sees_side(Index dual, bool top) const {
        return std::ranges::any_of(duals.corners_of(dual), [&](FacetCorner corner) {
            const double up = pose.unrotate(crossings.of(corner).normal)[2];
            return (top ? up : -up) > 0.9;
        });
    }
    /// Of the box to a point of it or around.
    double distance_to_corner(const Vec3& local) const {
        Vec3 off;
        for (unsigned k = 0; k < 3; ++k) off[k] = std::abs(local[k]) - size[k] / 2;
        return off.norm();
    }
};

} // namespace

TEST_CASE("what voxels share are the corners of a box, held by another voxel's chain", "[contour]") {
    std::size_t count = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Found found({1, 1, 1}, seed);
        for (const EdgeCollapse& edge : found.edges) {
            INFO("seed " << seed << ", from " << edge.from << " to " << edge.to);
            CHECK(edge.from != edge.to);
            CHECK(found.distance_to_corner(found.to_local(edge.position)) < 0.1 * found.level.voxel_size);
        }
        count += found.edges.size();
    }
    CHECK(count > 10);
}

TEST_CASE("a corner of a plate is never taken over from its far side", "[contour]") {
    std::size_t count = 0;
    for (std::uint64_t seed = 3001; seed <= 3040; ++seed) {
        const Found found({1, 0.8, 0.004}, seed);
        for (const EdgeCollapse& edge : found.edges) {
            INFO("seed " << seed << ", from " << edge.from << " to " << edge.to);
            CHECK_FALSE(found.sees_side(edge.to, found.to_local(edge.position)[2] < 0));
        }
        count += found.edges.size();
    }
    CHECK(count > 0);
}
