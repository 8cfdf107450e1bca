#include "hsdm/contour/bar_lines.hh"

#include "contour/stages.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/patches.hh"
#include "hsdm/quality/topology.hh"
#include "support/crowded_parts.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;
using namespace hsdm::support;

namespace {

Pose pose_in_cube(std::uint64_t seed) {
    Random random(seed);
    Pose pose = random_pose(random);
    pose.shift = Vec3(8, 8, 8);
    for (double& x : pose.shift) x += random.uniform(-0.5, 0.5);
    return pose;
}

/// Twenty points a voxel's face of a solid in a random pose in the middle of a cube of 16 voxels of edge 1.
PointCloud cloud_of_bars(const Solid& solid, double area, std::uint64_t seed, bool turned_normals) {
    PointCloud cloud = sample(solid.placed(pose_in_cube(seed)),
                              {.points = static_cast<std::size_t>(20 * area), .seed = seed});
    if (turned_normals)
        for (Vec3& n : cloud.normals) n = -n;
    cloud.positions.push_back(Vec3(0, 0, 0)); // keeps the octree's origin there
    cloud.normals.push_back(Vec3(0, 0, 0));
    return cloud;
}

Solid moved(const Solid& solid, const Vec3& way) {
    Pose pose;
    pose.shift = way;
    return solid.placed(pose);
}

/// A plate with three by three windows, two voxels wide: bars of `width` and half of it.
Solid grille(double width) {
    const double pitch = 2 + width, size = 3 * pitch + width;
    Solid plate = box({size, size, 0.5 * width});
    for (const double x : {-pitch, 0.0, pitch})
        for (const double y : {-pitch, 0.0, pitch}) plate = plate - moved(box({2, 2, width}), {x, y, 0});
    return plate;
}
double area_of_grille(double width) {
    const double pitch = 2 + width, size = 3 * pitch + width;
    return 2 * (size * size - 36) + 0.5 * width * (4 * size + 9 * 8);
}

/// The twelve edges of a cube of seven voxels; of the three ways through it no two have a plane in common.
Solid frame(double width) {
    const double inner = 7 - 2 * width;
    return box({7, 7, 7}) - box({8, inner, inner}) - box({inner + 0.02, 8, inner + 0.02})
           - box({inner + 0.04, inner + 0.04, 8});
}

constexpr double lattice_pitch = 3.7;
double area_of_lattice(double width) {
    return 54 * 4 * width * (lattice_pitch - width) + 54 * width * width; // as many faces of places are free
}

struct Counts {
    int right = 0, all = 0;
};

/// Of eight poses, both ways round.
Counts count_right(const Solid& solid, double area, long euler) {
    Counts counts;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        std::array<Topology, 2> topology;
        for (const bool turned_normals : {false, true}) {
            const Stages stages(cloud_of_bars(solid, area, seed, turned_normals), 4, 16);
            NormalSets sets = stages.sets;
            separate_patches(stages.octree, stages.level, stages.related, sets);
            const DualContour part = dual_contour(stages.octree, stages.level, sets);
            topology[turned_normals] = measure_topology(part.mesh);
            CHECK(topology[turned_normals].closed());
            counts.right += topology[turned_normals].euler == euler;
            ++counts.all;
        }
        CHECK(topology[0].euler == topology[1].euler);
    }
    return counts;
}

/// A rod, or with all normals turned a bore, `diameter` and `length` in voxels of edge 1, eight points a
/// voxel's face.
PointCloud rod_in(const Pose& pose, double diameter, double length, bool turned_normals, std::uint64_t seed) {
    const auto points = static_cast<std::size_t>(8 * std::numbers::pi * diameter * (length + 0.5 * diameter));
    PointCloud cloud =
        sample(cylinder(0.5 * diameter, length).placed(pose), {.points = points, .seed = seed});
    if (turned_normals)
        for (Vec3& n : cloud.normals) n = -n;
    return cloud;
}

/// The same along the diagonal of voxels of edge 1 whose corners have whole coordinates, past them by a tenth
/// at most.
PointCloud diagonal_rod(double diameter, bool turned_normals, std::uint64_t seed) {
    Random random(seed);
    Vec3 middle(7, 7, 7);
    for (double& x : middle) x += random.uniform(-0.1, 0.1);
    const Pose pose = turned({1, -1, 0}, -std::acos(std::sqrt(1.0 / 3)), middle);
    PointCloud cloud = rod_in(pose, diameter, 14, turned_normals, seed);
    cloud.positions.push_back(Vec3(0, 0, 0)); // keeps the octree's origin there
    cloud.normals.push_back(Vec3(0, 0, 0));
    return cloud;
}

} // namespace

TEST_CASE("rods and bores along the diagonal of voxels hold together", "[contour]") {
    // Its axis passes near a corner of every voxel that it passes, and no other corner lies in it. One seed
    // is left that comes apart in places, of 1.1 and of 1.2 voxels.
    int whole = 0;
    for (const double diameter : {1.1, 1.15, 1.2})
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            std::array<long, 2> euler{};
            for (const bool turned_normals : {false, true}) {
                INFO("diameter " << diameter << ", seed " << seed << (turned_normals ? ", bore" : ", rod"));
                const Stages stages(diagonal_rod(diameter, turned_normals, seed), 4, 16);
                const DualContour part = dual_contour(stages.octree, stages.level, stages.sets);
                const Topology topology = measure_topology(part.mesh);
                CHECK(topology.closed());
                CHECK(topology.euler == 2 * static_cast<long>(topology.components));
                CHECK(part.intersections.after == 0);
                euler[turned_normals] = topology.euler;
            }
            CHECK(euler[0] == euler[1]);
            whole += euler[0] == 2;
        }
    CHECK(whole >= 16);
}

TEST_CASE("grid points move into bars and bores, and nowhere else", "[contour]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        std::array<std::vector<Vec3>, 2> moved_by;
        for (const bool turned_normals : {false, true}) {
            const PointCloud cloud = cloud_of_bars(box({9, 0.5, 0.5}), 18.5, seed, turned_normals);
            const Stages stages(cloud, 4, 16);
            GridPoints grid = build_grid_points(stages.level);
            const std::size_t count = move_to_bar_lines(grid, stages.sets, stages.related, 1);
            CHECK(count >= 5); // the diagonal passes as many planes of one axis
            REQUIRE(grid.moved_by.size() == grid.size());
            moved_by[turned_normals] = grid.moved_by;
            std::size_t inside = 0, moved = 0;
            const Solid bar = box({12, 0.3, 0.3}).placed(pose_in_cube(seed)); // with where its line goes on
            for (Index c = 0; c < grid.size(); ++c) {
                if (!grid.is_moved(c)) continue;
                CHECK(grid.moved_by[c].norm() <= 1);
                ++moved;
                inside += bar.contains(grid.position(c));
            }
            CHECK(moved == count);
            CHECK(10 * inside >= 9 * moved);
        }
        CHECK(moved_by[0] == moved_by[1]);
    }
    for (const Solid& solid : {box({6, 5, 4}), box({8, 8, 0.5}), sphere(4)}) {
        const Stages stages(cloud_of_bars(solid, 150, 3, false), 4, 16);
        GridPoints grid = build_grid_points(stages.level);
        CHECK(move_to_bar_lines(grid, stages.sets, stages.related, 1) == 0);
        CHECK(grid.moved_by.empty());
    }
    const Solid wall = moved(box({4, 0.6, 6}), {2, 0, 0}); // from an axis outward
    Solid star = wall;
    for (const double turn : {2.0, 4.0})
        star = star | wall.placed(turned({0, 0, 1}, turn * std::numbers::pi / 3));
    for (std::uint64_t seed = 1; seed <= 6; ++seed) { // walls that meet are no bar
        const Stages stages(cloud_of_bars(star, 3 * 2 * 4 * 6, seed, seed % 2 == 0), 4, 16);
        GridPoints grid = build_grid_points(stages.level);
        CHECK(move_to_bar_lines(grid, stages.sets, stages.related, 1) <= 1);
    }
}

TEST_CASE("bars and bores thinner than a voxel hold together", "[contour]") {
    const auto right = [](const Counts& counts) { return std::to_string(counts.right) + " right"; };
    const Counts bars = count_right(box({9, 0.4, 0.4}), 14.7, 2);
    CHECK(bars.right == bars.all);
    const Counts bores = count_right(box({7, 4, 4}) - box({8, 0.7, 0.7}), 144 + 18.6, 0);
    INFO("bores " << right(bores));
    CHECK(bores.right == bores.all);
    const Counts windows = count_right(grille(1), area_of_grille(1), -16);
    INFO("windows " << right(windows));
    CHECK(windows.right >= windows.all - 2);
    const Counts frames = count_right(frame(1), 12 * 5 * 4, -8);
    INFO("frames " << right(frames));
    CHECK(frames.right >= frames.all - 2);
}

TEST_CASE("a crossing counts unless a bar or bore passes it, both ways round", "[contour]") {
    const auto upright = [](double width, double length, double middle) {
        return moved(box({width, width, length}), {8, 8, middle});
    };
    const Solid block = moved(box({6, 6, 4}), {8, 8, 6.5});     // its upper face at 8.5
    const Solid along = moved(box({8, 0.8, 0.8}), {8, 8, 7.7}); // 0.4 below it
    struct Case {
        const char* name;
        Solid solid;
        bool stands; ///< the crossing at (8, 8, 8.5), of what faces up there
    };
    for (const Case& part : {
             Case{"pin on a face", block | upright(0.6, 4, 9.5), false},
             Case{"bore into a face", block - upright(0.6, 2, 8.5), false},
             Case{"face", block, true},
             Case{"pin over a face", block | upright(0.8, 3, 10.3), true},
             Case{"skin over a bore that is parallel to it", block - along, true},
             Case{"bottom of a cup, from outside", block - upright(0.8, 3, 6.7), true},
         })
        for (const bool turned_normals : {false, true}) {
            INFO(part.name << (turned_normals ? ", turned" : ""));
            PointCloud cloud = sample(part.solid, {.points = 6000, .seed = 3});
            cloud.positions.push_back(Vec3(0, 0, 0)); // keeps the octree's origin there
            cloud.normals.push_back(Vec3(0, 0, 0));
            if (turned_normals)
                for (Vec3& n : cloud.normals) n = -n;
            const Stages stages(cloud, 4, 16);
            const GridPoints grid = build_grid_points(stages.level);
            const Index lower = grid.find(GridPoints::code({8, 8, 8}));
            REQUIRE(lower != no_index);
            const Index edge = 3 * lower + 2;
            Crossings crossings;
            crossings.first.assign(3 * grid.size() + 1, 0);
            std::fill(crossings.first.begin() + edge + 1, crossings.first.end(), Index{1});
            crossings.crossings.push_back({0.5, {0, 0, turned_normals ? -1.0 : 1.0}, edge, 0, true, true});
            crossings.moved.push_back({edge, {Vec3(0, 0, 0), Vec3(0, 0, 0)}});
            ask_points_at_bars(stages.octree, stages.level, grid, crossings);
            CHECK(crossings.crossings[0].standing == part.stands);
            CHECK(crossings.crossings[0].supported == part.stands);
        }
}

TEST_CASE("bars of a lattice hold together where several meet", "[contour][slow]") {
    for (const double width : {1.0, 1.2}) {
        const Counts lattices =
            count_right(lattice(width, lattice_pitch), area_of_lattice(width), 2 - 2 * 28);
        INFO("lattices of " << width << ": " << lattices.right << " right");
        CHECK(lattices.right >= lattices.all - 4);
    }
}
