#include "hsdm/pipeline/sparse_areas.hh"

#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/meshes.hh"
#include "support/sample.hh"
#include "support/uneven.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double density_ratio = 30;
const Vec3 dense_side = Vec3(1, 0.35, 0.2).normalized();

/// A third of the surface thirty times as dense as the rest.
PointCloud thirty_to_one(const Solid& solid, std::size_t points = 60000, double noise = 0) {
    return thinned_on_one_side(sample(solid, {.points = points, .position_noise = noise}), dense_side, 0.3,
                               density_ratio);
}

OctreeLevel level_of(const PointCloud& cloud, int depth, Octree& octree) {
    octree = build_octree(cloud);
    return extract_level(octree, depth);
}

/// The largest distance of the points of an even scan from a mesh.
double farthest_point(const Solid& solid, const PolygonMesh& mesh) {
    const MeshDistance distance(mesh);
    double most = 0;
    for (const Vec3& p : sample(solid, {.points = 4000, .seed = 5}).positions)
        most = std::max(most, distance(p));
    return most;
}

bool warns_of_small_voxels(const Report& report) {
    return std::ranges::count(report.warnings, std::string(warning_of::too_small), &Report::Warning::what)
           > 0;
}

} // namespace

TEST_CASE("voxels too small for a surface of these points to close are warned of where they were asked for",
          "[pipeline]") {
    const PointCloud even = sample(sphere(1), {.points = 5000});
    Octree octree;
    CHECK(voxels_too_small(level_of(even, 5, octree)).count == 0); // 1.1 points to a voxel
    const OctreeLevel fine = level_of(even, 6, octree);            // 0.27
    CHECK(voxels_too_small(fine).count > fine.size() / 2);
    ReconstructOptions options;
    options.depth = 6;
    const Report report = reconstruct(even, options).report;
    CHECK(warns_of_small_voxels(report));
    const auto said =
        std::ranges::find(report.warnings, std::string(warning_of::too_small), &Report::Warning::what);
    REQUIRE(said != report.warnings.end());
    CHECK(std::abs(said->where.norm() - 1) < 2 * report.grid.voxel_size);
    options.depth = 5;
    CHECK(reconstruct(even, options).report.warnings.empty());
    options.depth = {};
    options.voxel_size = octree.voxel_size(6);
    CHECK(warns_of_small_voxels(reconstruct(even, options).report));
    const auto levels = reconstruct_levels(even, 5, 6);
    REQUIRE(levels.size() == 2);
    CHECK_FALSE(warns_of_small_voxels(levels[0].report));
    CHECK(warns_of_small_voxels(levels[1].report));
    // Nobody asked for these, which are a few too small for the thin side, and coarser ones help there.
    CHECK_FALSE(warns_of_small_voxels(reconstruct(thirty_to_one(sphere(1)), {}).report));
}

TEST_CASE("voxels are too small where points are few, on one side of a cloud", "[pipeline]") {
    Octree octree;
    const OctreeLevel level = level_of(thirty_to_one(sphere(1)), 6, octree);
    const Occurrences small = voxels_too_small(level);
    CHECK(small.count > 0);
    CHECK(small.count < level.size() / 2);
}

TEST_CASE("coarser levels help where points are too few for a level's voxels, and no further", "[pipeline]") {
    Octree octree;
    const PointCloud even = sample(sphere(1), {.points = 20000});
    // voxels of 1/8, 1/16 and 1/32: 25, 6 and 1.6 points to a squared voxel
    CHECK(levels_above_sparse(level_of(even, 4, octree)) == 0);
    CHECK(levels_above_sparse(level_of(even, 5, octree)) == 0);
    CHECK(levels_above_sparse(level_of(even, 6, octree)) == 1);
    CHECK(levels_above_sparse(level_of(even, 7, octree)) == 2);
    PointCloud scattered = even;
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        scattered.positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        scattered.normals.push_back(random.direction());
    }
    CHECK(levels_above_sparse(level_of(scattered, 5, octree)) == 0);
}

TEST_CASE("points come between sparse ones, none where dense data have a hole or are whole", "[pipeline]") {
    // A square of 2 by 2: at x > 0 dense, with a round hole of radius 0.25 about (0.5, 0); sparse at x < 0.
    Random random(4);
    PointCloud cloud;
    for (int i = 0; i < 60000; ++i) {
        const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), 0);
        if (p[0] < 0 ? random.uniform() * density_ratio > 1 : (p - Vec3(0.5, 0, 0)).norm() < 0.25) continue;
        cloud.positions.push_back(p);
        cloud.normals.emplace_back(0, 0, 1);
    }
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 6);
    REQUIRE(levels_above_sparse(level) > 0);
    const SparseAreas areas(octree, level, 2);
    const PolygonMesh whole = quad_sheet(16, 16, [](Index c, Index r) { return Vec3(c / 8.0, r / 8.0, 0); });
    const CompletedPoints points = areas.points_between(whole, 0);
    std::size_t far_inside = 0;
    for (const Vec3& relative : points.positions) {
        const Vec3 p = relative + octree.origin;
        far_inside += p[0] < -0.1;
        CHECK(p[0] < 2 * areas.level(2).voxel_size);
        CHECK(std::abs(p[2]) < 1e-12);
    }
    // nine to a voxel and more, of which 0.9 by 2 have 1/32 by 1/32
    const double voxels = 0.9 * 2 * 32 * 32;
    CHECK(static_cast<double>(far_inside) > 9 * voxels);
    CHECK(static_cast<double>(far_inside) < 14 * voxels);
}

TEST_CASE("points between sparse ones lie on a round surface, not on its chords", "[pipeline]") {
    const PointCloud cloud = sample(sphere(1), {.points = 1000});
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 5);
    const SparseAreas areas(octree, level, 3);
    PolygonMesh coarse = divided_sphere(6);
    double sagitta = 0;
    for (std::size_t f = 0; f < coarse.facet_count(); ++f) {
        Vec3 middle(0, 0, 0);
        for (const Index v : coarse.facet(f)) middle += coarse.positions[v] / 4;
        sagitta = std::max(sagitta, 1 - middle.norm());
    }
    for (Vec3& p : coarse.positions) p -= octree.origin;
    const CompletedPoints points = areas.points_between(coarse, 0);
    REQUIRE(points.positions.size() > 4000);
    double off = 0;
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Vec3 p = points.positions[i] + octree.origin;
        off = std::max(off, std::abs(p.norm() - 1));
        CHECK((p.normalized() | points.normals[i]) > 0.995);
    }
    CHECK(off < sagitta / 4);
}

TEST_CASE("a surface thirty times as dense on one side comes out whole", "[pipeline][slow]") {
    struct Part {
        const char* name;
        Solid solid;
        long euler;
        double farthest; // voxels, of the surface from the mesh
    };
    Random random(3);
    const Pose pose = random_pose(random);
    for (const Part& part :
         {Part{"sphere", sphere(1), 2, 0.5}, Part{"box", box({1.4, 1.1, 0.5}).placed(pose), 2, 1},
          Part{"torus", torus(1, 0.4).placed(pose), 0, 0.5}})
        for (const NormalSource normals : {NormalSource::given, NormalSource::estimate})
            for (const double noise : {0.0, 0.004}) {
                INFO(part.name << (normals == NormalSource::given ? ", given" : ", estimated") << ", noise "
                               << noise);
                ReconstructOptions options;
                options.normals = normals;
                const Reconstruction made = reconstruct(thirty_to_one(part.solid, 100000, noise), options);
                const PolygonMesh mesh = to_polygons(made.mesh);
                CHECK(faults(mesh).empty());
                CHECK(made.report.mesh.closed);
                CHECK(made.report.mesh.components == 1);
                CHECK(made.report.mesh.euler == part.euler);
                CHECK(find_self_intersections(mesh).facet_pairs.empty());
                CHECK(farthest_point(part.solid, mesh)
                      < part.farthest * made.report.grid.voxel_size + 2 * noise);
                CHECK(made.report.options.at("resolution").find("times as wide where the points are sparser")
                      != std::string::npos);
            }
}

TEST_CASE("a border stays where points are sparse", "[pipeline]") {
    PointCloud bowl = thirty_to_one(sphere(1), 100000);
    PointCloud open;
    for (std::size_t i = 0; i < bowl.size(); ++i)
        if (bowl.positions[i][2] < 0.3)
            open.positions.push_back(bowl.positions[i]), open.normals.push_back(bowl.normals[i]);
    const Reconstruction made = reconstruct(open, ReconstructOptions{});
    CHECK(made.report.mesh.boundary_loops == 1);
    CHECK(made.report.mesh.euler == 1);
    for (const auto v : made.mesh.vertices())
        if (made.mesh.is_boundary(v)) CHECK(std::abs(made.mesh.point(v)[2] - 0.3) < 0.2); // three spacings
}

TEST_CASE("voxels that were asked for are those of the measured points alone", "[pipeline]") {
    const PointCloud cloud = thirty_to_one(sphere(1));
    ReconstructOptions options;
    options.depth = 6;
    const Reconstruction made = reconstruct(cloud, options);
    CHECK(made.report.options.at("resolution") == "as asked by depth");
    CHECK_FALSE(made.report.mesh.closed);
}
