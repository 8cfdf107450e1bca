#include "contour/stages.hh"
#include "hsdm/contour/shared_corners.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// A box in some pose, and the edges to its corners.
struct FoundCorners {
    Vec3 size;
    support::Pose pose;
    support::Stages stages;
    std::vector<EdgeCollapse> edges;

    FoundCorners(const Vec3& box_size, std::uint64_t seed)
        : size(box_size),
          pose(support::random_pose(seed)),
          stages(support::box(size).placed(pose), 5000, 4),
          edges(shared_corners(stages, stages.vertices)) {}

    Vec3 to_local(const Vec3& p) const { return pose.to_local(p + stages.octree.origin); }
    /// Does a chain pass the box's top or bottom?
    bool sees_side(Index dual, bool top) const {
        return std::ranges::any_of(stages.duals.corners_of(dual), [&](FacetCorner corner) {
            const double up = pose.unrotate(stages.crossings.of(corner).normal)[2];
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
        const FoundCorners found({1, 1, 1}, seed);
        for (const EdgeCollapse& edge : found.edges) {
            INFO("seed " << seed << ", from " << edge.from << " to " << edge.to);
            CHECK(edge.from != edge.to);
            CHECK(found.distance_to_corner(found.to_local(edge.position)) < 0.1 * found.stages.h());
        }
        count += found.edges.size();
    }
    CHECK(count > 10);
}

TEST_CASE("a corner of a plate is never taken over from its far side", "[contour]") {
    std::size_t count = 0;
    for (std::uint64_t seed = 3001; seed <= 3040; ++seed) {
        const FoundCorners found({1, 0.8, 0.004}, seed);
        for (const EdgeCollapse& edge : found.edges) {
            INFO("seed " << seed << ", from " << edge.from << " to " << edge.to);
            CHECK_FALSE(found.sees_side(edge.to, found.to_local(edge.position)[2] < 0));
        }
        count += found.edges.size();
    }
    CHECK(count > 0);
}
