#include "hsdm/contour/patches.hh"
#include "hsdm/contour/sheet_widths.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double voxel_edge = 1.0 / 16;

/// Eight points to a squared voxel, as the scans have on which walls and gaps were measured.
PointCloud evenly_scanned(const Solid& solid, double area, std::uint64_t seed) {
    return sample(solid,
                  {.points = static_cast<std::size_t>(8 * area / (voxel_edge * voxel_edge)), .seed = seed});
}

Solid fin(double width) {
    return box({2, 1, 0.3}) | box({width, 0.8, 0.8}).placed(turned({0, 0, 1}, 0, {0, 0, 0.4}));
}

Solid slot(double width) {
    return box({2, 1, 0.8}) - box({width, 2, 0.8}).placed(turned({0, 0, 1}, 0, {0, 0, 0.4}));
}

/// Two boxes that face each other.
Solid pair(double gap) {
    const double away = 0.5 + 0.5 * gap;
    return box({1, 1, 0.5}).placed(turned({0, 0, 1}, 0, {-away, 0, 0}))
           | box({1, 1, 0.5}).placed(turned({0, 0, 1}, 0, {away, 0, 0}));
}

/// The sets of a scan, before and after their patches were separated.
struct Separated {
    explicit Separated(const PointCloud& cloud)
        : octree(build_octree(cloud)),
          level(extract_level(octree, 5)),
          related({}, level.voxel_size),
          before(build_normal_sets(octree, level)),
          after(before),
          counts(separate_patches(octree, level, related, after)) {}

    Octree octree;
    OctreeLevel level;
    RelationTest related;
    NormalSets before, after;
    PatchCounts counts;
};

/// Which points are in one set, whatever its number.
std::set<std::set<Index>> partition(const NormalSets& sets, const OctreeLevel& level) {
    std::vector<std::set<Index>> members(sets.sets.size());
    for (Index s = 0; s < members.size(); ++s)
        sets.for_points_of(s, level, [&](Index p) { members[s].insert(p); });
    return {members.begin(), members.end()};
}

PointCloud turned_inside_out(PointCloud cloud) {
    for (Vec3& n : cloud.normals) n = -n;
    return cloud;
}

} // namespace

TEST_CASE("the ground on both sides of a wall below a voxel is two patches", "[contour]") {
    const Separated fins(evenly_scanned(fin(0.5 * voxel_edge).placed(random_pose(1)), 8, 1));
    CHECK(fins.counts.split > 0);
    CHECK(fins.counts.apart > 50);
    REQUIRE(fins.after.sets.size() == fins.before.sets.size() + fins.counts.split);
    REQUIRE(fins.after.first.back() == fins.after.sets.size());
    REQUIRE(fins.after.first_apart.size() == fins.after.sets.size() + 1);
    // Each set is what its points make, and no two sets share one.
    std::vector<std::vector<Index>> points(fins.after.sets.size());
    for (Index s = 0; s < points.size(); ++s)
        fins.after.for_points_of(s, fins.level, [&](Index p) { points[s].push_back(p); });
    for (Index v = 0; v < fins.level.size(); ++v)
        for (Index s = fins.after.first[v]; s < fins.after.first[v + 1]; ++s) {
            CHECK(fins.after.sets[s].voxel == v);
            const NormalSet again = measure_set(fins.octree, points[s], v, fins.level.voxel_size);
            CHECK(fins.after.sets[s].count == again.count);
            CHECK((fins.after.sets[s].centroid - again.centroid).norm() == 0);
        }
}

TEST_CASE("sets apart have no relation, whichever is asked first, and others keep theirs", "[contour]") {
    const Separated slots(evenly_scanned(slot(0.5 * voxel_edge).placed(random_pose(2)), 8, 2));
    REQUIRE(slots.counts.apart > 0);
    const RelationTest patches({}, slots.level.voxel_size, slots.after);
    const auto& sets = slots.after.sets;
    for (Index a = 0; a < sets.size(); ++a) {
        const auto first = slots.after.apart.begin() + slots.after.first_apart[a];
        const auto last = slots.after.apart.begin() + slots.after.first_apart[a + 1];
        for (Index b = 0; b < sets.size(); ++b) {
            const bool apart = std::find(first, last, b) != last;
            if (apart) CHECK(patches(sets[a], sets[b]) == Relation::none);
            if (apart) CHECK(patches(sets[b], sets[a]) == Relation::none);
            if (!apart && patches(sets[a], sets[b]) != slots.related(sets[a], sets[b]))
                FAIL(a << " and " << b);
        }
    }
}

TEST_CASE("a gap is a wall of what is around it: turned normals make the same patches", "[contour]") {
    for (const Solid& solid : {fin(0.5 * voxel_edge), slot(0.4 * voxel_edge), pair(0.5 * voxel_edge)}) {
        const PointCloud cloud = evenly_scanned(solid.placed(random_pose(3)), 8, 3);
        const Separated out(cloud), in(turned_inside_out(cloud));
        CHECK(out.counts.split > 0);
        CHECK(partition(out.after, out.level) == partition(in.after, in.level));
        CHECK(out.after.first_apart == in.after.first_apart);
        CHECK(out.after.apart == in.after.apart);
    }
}

TEST_CASE("thick parts have no walls, and the rim of a plate is not split", "[contour]") {
    const Separated block(evenly_scanned(box({1, 0.9, 0.8}).placed(random_pose(4)), 5, 4));
    CHECK(block.counts.crowded == 0);
    CHECK(partition(block.before, block.level) == partition(block.after, block.level));
    const Separated plate(evenly_scanned(box({1, 0.9, 0.7 * voxel_edge}).placed(random_pose(5)), 2, 5));
    CHECK(plate.counts.crowded > 50);
    CHECK(plate.counts.split == 0);
}

TEST_CASE("the two sheets of a voxel are as far apart as the solid says, in spacings of their points",
          "[contour][accuracy]") {
    for (const double density : {24.0, 48.0})
        for (const double width : {0.3, 0.6}) {
            INFO(density << " points to a squared voxel, " << width << " voxels");
            const Solid plate = box({1, 0.9, width * voxel_edge}).placed(random_pose(7));
            const Separated thin(evenly_scanned(plate, 2 * density / 8, 7));
            double sum = 0, voxels = 0;
            for (Index v = 0; v < thin.level.size(); ++v)
                if (const auto pair = nearest_pair(thin.level, thin.after, v))
                    sum += pair->spacings, ++voxels;
            REQUIRE(voxels > 50);
            // The octree's voxels are those of its own cube: lengths are compared, not voxels.
            const double spacing = voxel_edge / std::sqrt(density);
            CHECK(sum / voxels == Approx(width * voxel_edge / spacing).epsilon(0.15));
        }
}

TEST_CASE("walls and gaps too narrow for their points are doubtful where they stand, told by place",
          "[contour]") {
    const Pose pose = random_pose(8);
    for (const double width : {0.15, 0.25}) {
        const Separated fins(evenly_scanned(fin(width * voxel_edge).placed(pose), 8, 8));
        const Separated slots(evenly_scanned(slot(width * voxel_edge).placed(pose), 8, 8));
        const Occurrences foot = crowded_sheets(fins.level, fins.after);
        const Occurrences mouth = crowded_sheets(slots.level, slots.after);
        CHECK(foot.count > 5);
        CHECK(mouth.count > 5);
        // Between the two sides, which are at x = 0 of the solid.
        CHECK(std::abs(pose.to_local(foot.first + fins.octree.origin)[0]) < 2 * voxel_edge);
        CHECK(std::abs(pose.to_local(mouth.first + slots.octree.origin)[0]) < 2 * voxel_edge);
    }
}

TEST_CASE("free walls of any width are next to never doubtful, wide ones on a ground never", "[contour]") {
    for (const double width : {0.5, 1.0}) { // thinner than a spacing some are told at their corners
        const Separated plate(evenly_scanned(box({1, 0.9, width * voxel_edge}).placed(random_pose(9)), 2, 9));
        CHECK(crowded_sheets(plate.level, plate.after).count < 3); // of some 200 voxels
    }
    for (const Solid& solid : {fin(1.2 * voxel_edge), slot(1.2 * voxel_edge), box({1, 0.9, 0.8})}) {
        const Separated wide(evenly_scanned(solid.placed(random_pose(9)), 8, 9));
        CHECK(crowded_sheets(wide.level, wide.after).count == 0);
    }
}

TEST_CASE("a gap is as doubtful as a wall: turned normals change nothing", "[contour]") {
    const PointCloud cloud = evenly_scanned(fin(0.2 * voxel_edge).placed(random_pose(10)), 8, 10);
    const Separated out(cloud), in(turned_inside_out(cloud));
    REQUIRE(crowded_sheets(out.level, out.after).count > 0);
    CHECK(crowded_sheets(out.level, out.after).count == crowded_sheets(in.level, in.after).count);
}
