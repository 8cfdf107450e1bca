#include "contour/stages.hh"
#include "hsdm/contour/grid_signs.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

using namespace hsdm;

namespace {

/// All that comes before label_grid_signs.
struct Found {
    Octree octree;
    OctreeLevel level;
    NormalSets sets;
    RelationTest related;
    GridPoints grid;
    LocalSheets local;
    Crossings candidates;

    Found(const support::Solid& solid, std::size_t points, int depth)
        : octree(build_octree(scan(solid, points), {})),
          level(extract_level(octree, depth)),
          sets(build_normal_sets(octree, level)),
          related({}, level.voxel_size),
          grid(build_grid_points(level)),
          local(group_local_sheets(grid, sets, related, level.voxel_size)) {
        extend_grid_points(grid, local, level);
        candidates = find_crossings(grid, local, sets, related, level.voxel_size);
    }

    static PointCloud scan(const support::Solid& solid, std::size_t points) {
        return support::sample(solid, {.points = points});
    }

    Crossings settled() const {
        return label_grid_signs(grid, beliefs_of_sheets(local, level.voxel_size), sets, candidates,
                                level.voxel_size);
    }
    Crossings standing() const {
        Crossings result;
        for (Index edge = 0; edge + 1 < candidates.first.size(); ++edge) {
            for (const Crossing& x : candidates.on_edge(edge))
                if (x.standing) result.crossings.push_back(x);
            result.first.push_back(static_cast<Index>(result.crossings.size()));
        }
        return result;
    }
    std::size_t open_sides(const Crossings& crossings) const {
        return support::open_sides(pair_crossings(grid, crossings, sets, related));
    }
};

} // namespace

TEST_CASE("crossings that agree leave no side open and are left alone", "[contour]") {
    const Found found(support::sphere(1), 20000, 4);
    const Crossings crossings = found.settled();
    CHECK(crossings.settled == 0);
    CHECK(crossings.crossings.size() > 500);
    CHECK(found.open_sides(crossings) == 0);
}

TEST_CASE("crossings lost at random come back and the surface closes", "[contour]") {
    Found found(support::torus(1, 0.4), 40000, 5);
    const std::size_t all = found.settled().crossings.size();
    support::Random random(3);
    std::size_t lost = 0;
    for (Crossing& x : found.candidates.crossings)
        if (x.standing && random.uniform() < 0.05) x.standing = false, ++lost;
    const Crossings crossings = found.settled();
    CHECK(lost > 50);
    CHECK(crossings.settled == lost);
    CHECK(crossings.crossings.size() == all);
    CHECK(found.open_sides(crossings) == 0);
}

TEST_CASE("what is clipped just beyond a crease is less sure to be clipped", "[contour]") {
    const Vec3 half(0.5, 0.45, 0.4);
    const support::Pose pose = support::random_pose(4);
    const Found found(support::box(2 * half).placed(pose), 20000, 5);
    const double error = 0.15 * found.level.voxel_size;
    std::size_t unsure = 0, as_far = 0;
    for (const Crossing& crossing : found.candidates.crossings) {
        const double sureness = crossing.sureness;
        CHECK((sureness >= 0 && sureness <= 1));
        if (crossing.standing) CHECK(sureness == 1);
        if (sureness == 1) continue;
        const Vec3 at = pose.to_local(crossing_position(found.grid, crossing, found.level.voxel_size)
                                      + found.octree.origin);
        double off = 0; // beyond the farthest face
        for (unsigned k = 0; k < 3; ++k) off = std::max(off, std::abs(at[k]) - half[k]);
        ++unsure;
        as_far += std::abs(off - sureness * error) < 0.01 * error;
    }
    CHECK(unsure > 50);
    CHECK(as_far * 10 > unsure * 9);
}

TEST_CASE("where many creases meet, settling closes most faces that the sheets leave open",
          "[contour][slow]") {
    using support::box;
    support::Random random(8);
    std::size_t open_before = 0, open_after = 0;
    for (int i = 0; i < 12; ++i) {
        const support::Solid solid = (box({1, 1, 1}) | box({1, 0.9, 0.8}).placed(random_pose(random, 0.4)))
                                     - box({0.8, 0.9, 1}).placed(random_pose(random, 0.4));
        const Found found(solid, 15000, 5);
        open_before += found.open_sides(found.standing());
        open_after += found.open_sides(found.settled());
    }
    CHECK(open_before > 1000);
    CHECK(open_after < open_before / 3);
}

TEST_CASE("settled crossings do not depend on the number of threads", "[contour]") {
    const Found found(support::mechanical_part(), 20000, 5);
    const Crossings many = found.settled();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Crossings single = found.settled();
    CHECK(many.first == single.first);
    CHECK(many.settled == single.settled);
    bool same = many.crossings.size() == single.crossings.size();
    for (std::size_t i = 0; same && i < many.crossings.size(); ++i)
        same =
            many.crossings[i].t == single.crossings[i].t && many.crossings[i].set == single.crossings[i].set;
    CHECK(same);
}

TEST_CASE("a box whose faces lie on grid planes keeps its corners", "[contour]") {
    const support::Solid cube = support::box({1, 1, 1});
    const Found found(cube, 3000, 3);
    const Crossings crossings = found.settled();
    CHECK(found.open_sides(crossings) == 0);
    double farthest = 0;
    for (const Crossing& x : crossings.crossings)
        farthest =
            std::max(farthest, std::abs(cube.distance(crossing_position(found.grid, x, found.level.voxel_size)
                                                      + found.octree.origin)));
    CHECK(farthest < 0.15 * found.level.voxel_size);
}
