#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/errors.hh"
#include "hsdm/pipeline/extended_graph.hh"
#include "hsdm/quality/distance.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace hsdm;
using support::faults;

namespace {

PointCloud scan(const support::Solid& solid, std::size_t points, std::uint64_t seed = 1) {
    return support::sample(solid, {.points = points, .seed = seed});
}

int depth_for(double extent, double voxel_size) {
    int depth = 1;
    while (voxel_size * (1 << depth) < extent) ++depth;
    return depth;
}

/// An octree with a cube that has voxels of exactly that size.
Octree octree_of(const PointCloud& cloud, double voxel_size) {
    return build_octree(cloud,
                        {.cube_extent = voxel_size * (1 << depth_for(cloud.bounds().extent(), voxel_size))});
}

DualContour facets_of(const PointCloud& cloud, double voxel_size, const DualContourOptions& options = {}) {
    const Octree octree = octree_of(cloud, voxel_size);
    const OctreeLevel level = extract_level(octree, depth_for(octree.bounds.extent(), voxel_size));
    NormalSets sets = build_normal_sets(octree, level);
    drop_outlier_sets(level, RelationTest(options.relation, level.voxel_size), sets);
    DualContour facets = dual_contour(octree, level, sets, options);
    for (Vec3& p : facets.mesh.positions) p += octree.origin;
    return facets;
}

/// A random solid's scan; some of its normals are flipped or, for each third seed, all point anywhere.
void check_unaided(std::uint64_t seed, std::size_t points, double voxel) {
    DualContourOptions unaided;
    unaided.fill = false;
    PointCloud cloud = scan(support::random_solid(seed), points, seed);
    support::Random random(seed);
    for (Vec3& n : cloud.normals)
        if (random.uniform(0, 1) < 0.1 * static_cast<double>(seed % 5)) n = -n; // some flipped
    if (seed % 3 == 0)
        for (Vec3& n : cloud.normals)
            n = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    INFO("seed " << seed);
    const DualContour facets = facets_of(cloud, voxel, unaided);
    const Topology t = measure_topology(facets.mesh);
    const ManifoldCounts& mended = facets.manifold;
    // Two facets back to back are a bubble, closed in itself, and cancel.
    CHECK(mended.degenerate + mended.duplicates + mended.complex_edges == 0);
    CHECK(mended.opened_edges + mended.split_vertices == 0);
    CHECK(t.manifold());
    CHECK(t.misoriented_edges == 0);
    CHECK(t.degenerate_facets == 0);
    CHECK(t.duplicate_facets == 0);
    CHECK(t.isolated_vertices == 0);
}

} // namespace

TEST_CASE("smooth and sharp solids in general pose come out closed, of the right genus, near the surface",
          "[contour][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        std::size_t points;
        double voxel;
        long euler;
        double tolerance; // voxels
    };
    const std::vector<Example> examples = {
        {"sphere", support::sphere(1), 20000, 0.125, 2, 0.15},
        {"torus", support::torus(1, 0.35), 40000, 0.1, 0, 0.15},
        {"box", support::box({1, 1.3, 0.8}), 30000, 0.1, 2, 0.25},
        {"wedge", support::wedge(0.52, 1, 1), 30000, 0.08, 2, 0.5},
        {"mechanical part", support::mechanical_part(), 100000, 0.1, -4, 0.3},
    };
    for (const Example& e : examples)
        for (std::uint64_t seed : {1u, 2u, 3u}) {
            INFO(e.name << ", pose " << seed);
            const support::Solid solid = e.solid.placed(support::random_pose(seed));
            const DualContour facets = facets_of(scan(solid, e.points, seed), e.voxel);
            const Topology t = measure_topology(facets.mesh);
            CHECK(faults(facets.mesh) == "");
            CHECK(t.closed());
            CHECK(t.euler == e.euler);
            CHECK(t.components == 1);
            CHECK(support::farthest_vertex(facets.mesh, solid) < e.tolerance * e.voxel);
            CHECK(static_cast<double>(t.quads) > 0.9 * static_cast<double>(t.faces));
        }
}

TEST_CASE("a thin wedge reaches to nearly all tips of its edge", "[contour]") {
    // A tip that crosses no edge of its voxel has no vertex there: that of the next voxel moves to it.
    int cut_off = 0; // of 48; 9 if none moved
    const double angle = 0.25, length = 1, height = 0.7, voxel = 0.07;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        INFO("pose " << seed);
        const support::Pose pose = support::random_pose(seed);
        const support::Solid wedge = support::wedge(angle, length, height).placed(pose);
        const DualContour facets = facets_of(scan(wedge, 12000, seed), voxel);
        CHECK(faults(facets.mesh) == "");
        for (const double z : {-0.5, 0.5}) {
            const Vec3 tip = pose.to_world(Vec3(0, 0, z * height));
            double nearest = std::numeric_limits<double>::infinity();
            for (const Vec3& p : facets.mesh.positions) nearest = std::min(nearest, (p - tip).norm());
            cut_off += nearest > 0.5 * voxel;
        }
    }
    CHECK(cut_off <= 2);
}

TEST_CASE("the two sides of a plate in one voxel stay two, and the rim closes them", "[contour][slow]") {
    for (double voxel : {0.04, 0.08})
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            INFO("plate of 0.02, voxel " << voxel << ", pose " << seed);
            const support::Solid plate = support::box({1, 0.7, 0.02}).placed(support::random_pose(seed));
            const DualContour facets = facets_of(scan(plate, 60000, seed), voxel);
            const Topology t = measure_topology(facets.mesh);
            CHECK(faults(facets.mesh) == "");
            CHECK(t.closed());
            CHECK(t.euler == 2);
            CHECK(support::farthest_vertex(facets.mesh, plate) < 0.15 * voxel);
        }
}

TEST_CASE("nested spheres half a voxel apart stay two closed surfaces", "[contour][slow]") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        INFO("pose " << seed);
        const support::Solid shell = support::nested_spheres(1, 0.95).placed(support::random_pose(seed));
        const DualContour facets = facets_of(scan(shell, 100000, seed), 0.1);
        const Topology t = measure_topology(facets.mesh);
        CHECK(faults(facets.mesh) == "");
        CHECK(t.closed());
        CHECK(t.components == 2);
        CHECK(t.euler == 4);
    }
}

TEST_CASE("strays all around a sphere leave it one closed surface", "[contour]") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        INFO("seed " << seed);
        const support::Solid solid = support::sphere(1);
        PointCloud cloud = scan(solid, 20000, seed);
        support::Random random(seed);
        const auto anywhere = [&](double r) {
            return Vec3(random.uniform(-r, r), random.uniform(-r, r), random.uniform(-r, r));
        };
        for (int i = 0; i < 1000; ++i) {
            cloud.positions.push_back(anywhere(1.1));
            cloud.normals.push_back(anywhere(1).normalized());
        }
        const DualContour facets = facets_of(cloud, 0.14);
        const Topology t = measure_topology(facets.mesh);
        CHECK(faults(facets.mesh) == "");
        CHECK(t.closed());
        CHECK(t.components == 1);
        CHECK(t.euler == 2);
    }
}

TEST_CASE("every corner of a box gets a vertex of its own", "[contour]") {
    const support::Pose placed = support::random_pose(5);
    const DualContour facets = facets_of(scan(support::box({1, 1, 1}).placed(placed), 30000), 0.12);
    for (unsigned k = 0; k < 8; ++k) {
        const Vec3 corner = placed.to_world(Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5));
        double nearest = 1;
        for (const Vec3& p : facets.mesh.positions) nearest = std::min(nearest, (p - corner).norm());
        CHECK(nearest < 0.25 * 0.12);
    }
}

TEST_CASE("relaxation leaves facets, voxels and corners alone", "[contour]") {
    const double voxel = 0.12;
    const PointCloud cloud = scan(support::torus(1, 0.4), 40000);
    DualContourOptions as_placed;
    as_placed.relax = {.rounds = 0, .fit = false};
    const DualContour before = facets_of(cloud, voxel, as_placed), after = facets_of(cloud, voxel);
    REQUIRE(before.mesh.corners == after.mesh.corners);
    CHECK(before.classes == after.classes);
    const Octree octree = octree_of(cloud, voxel);
    const OctreeLevel level = extract_level(octree, depth_for(octree.bounds.extent(), voxel));
    const auto voxel_at = [&](const Vec3& p) {
        VoxelCoord c;
        for (unsigned k = 0; k < 3; ++k)
            c[k] = static_cast<std::int32_t>(std::floor((p[k] - octree.origin[k]) / voxel));
        return c;
    };
    std::size_t moved = 0;
    for (std::size_t v = 0; v < after.mesh.vertex_count(); ++v) {
        const Vec3 &p = before.mesh.positions[v], &q = after.mesh.positions[v];
        // One that reaches into the next voxel may come back into its own.
        const bool back = voxel_at(q) == level.coord(before.voxel[v]);
        CHECK((back || voxel_at(p) == voxel_at(q)));
        if (before.classes[v] == VertexClass::corner) CHECK(p == q);
        moved += p != q;
    }
    CHECK(2 * moved > after.mesh.vertex_count());
    as_placed.relax.rounds = -1;
    CHECK_THROWS_AS(facets_of(cloud, voxel, as_placed), OptionError);
    as_placed.relax = {.rounds = 1, .step = 0};
    CHECK_THROWS_AS(facets_of(cloud, voxel, as_placed), OptionError);
}

TEST_CASE("relaxed facets lie no farther from the points, and nearer where the surface is curved",
          "[contour][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        double noise;         // voxels
        double most;          // distance of the points, of that as placed
        double most_to_truth; // distance of the facets from the solid, likewise
    };
    const std::vector<Example> examples = {
        {"sphere", support::sphere(1), 0, 0.6, 0.6},
        {"torus", support::torus(1, 0.4), 0, 0.8, 0.8},
        {"cylinder", support::cylinder(0.6, 1.5), 0, 0.8, 0.8},
        {"box", support::box({1, 1.3, 0.8}), 0, 1.001, 1.001},
        {"mechanical part", support::mechanical_part(), 0, 0.9, 0.9},
        {"noisy sphere", support::sphere(1), 0.3, 1.005, 1.05},
        {"noisy box", support::box({1, 1.3, 0.8}), 0.3, 1.005, 1.05},
    };
    const double voxel = 0.12;
    DualContourOptions as_placed;
    as_placed.relax = {.rounds = 0, .fit = false};
    for (const Example& example : examples) {
        INFO(example.name);
        const support::Solid solid = example.solid.placed(support::random_pose(5));
        const PointCloud cloud =
            support::sample(solid, {.points = 20000, .position_noise = example.noise * voxel});
        const PolygonMesh before = facets_of(cloud, voxel, as_placed).mesh,
                          after = facets_of(cloud, voxel).mesh;
        CHECK(points_to_mesh(cloud.positions, after).mean
              <= example.most * points_to_mesh(cloud.positions, before).mean);
        const auto to_truth = [&](const PolygonMesh& mesh) {
            double sum = 0;
            for (const Vec3& p : sample_surface(mesh, 20000)) sum += std::abs(solid.distance(p));
            return sum;
        };
        CHECK(to_truth(after) <= example.most_to_truth * to_truth(before));
    }
}

TEST_CASE("an open sheet keeps its border and does not grow beyond the points by a voxel", "[contour]") {
    PointCloud cloud;
    support::Random random(4);
    for (int i = 0; i < 20000; ++i) {
        cloud.positions.emplace_back(random.uniform(0, 1), random.uniform(0, 1),
                                     0.1 * random.uniform(0, 1e-3));
        cloud.normals.emplace_back(0, 0, 1);
    }
    const double voxel = 0.06;
    const DualContour facets = facets_of(cloud, voxel);
    const Topology t = measure_topology(facets.mesh);
    CHECK(faults(facets.mesh) == "");
    CHECK(t.boundary_loops == 1);
    CHECK(t.euler == 1);
    const Box box = cloud.bounds();
    for (const Vec3& p : facets.mesh.positions)
        for (unsigned k : {0u, 1u}) {
            CHECK(p[k] > box.lo[k] - voxel);
            CHECK(p[k] < box.hi[k] + voxel);
        }
}

TEST_CASE("a slot at the end of a narrow pipe stays open", "[contour]") {
    constexpr double slot = 2, length = 10; // radians, voxels
    DualContourOptions unaided;
    unaided.fill = false;
    for (const double radius : {1.0, 1.3, 1.6}) {
        INFO("radius of " << radius << " voxels");
        std::size_t vertices_in_slot = 0;
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            support::Random random(seed);
            const support::Pose pose = support::random_pose(random);
            PointCloud cloud;
            while (cloud.size() < 1500) {
                const double angle = random.uniform(0, 2 * std::numbers::pi), z = random.uniform(0, length);
                if (z > length / 2 && angle < slot) continue;
                const Vec3 n(std::cos(angle), std::sin(angle), 0);
                cloud.positions.push_back(pose.to_world(n * radius + Vec3(0, 0, z)));
                cloud.normals.push_back(pose.rotate(n));
            }
            for (const Vec3& p : facets_of(cloud, 1, unaided).mesh.positions) {
                const Vec3 q = pose.to_local(p);
                const double angle = std::atan2(q[1], q[0]);
                vertices_in_slot += q[2] > length / 2 + 0.5 && std::abs(angle - slot / 2) < slot / 4;
            }
        }
        CHECK(vertices_in_slot < 50); // of a slot closed all over, some 150
    }
}

TEST_CASE("a round part a few voxels thick is mostly quads", "[contour]") {
    std::size_t triangles = 0, facets = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const PolygonMesh mesh =
            facets_of(scan(support::torus(4, 1.2).placed(support::random_pose(seed)), 8000, seed), 1).mesh;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) triangles += mesh.facet(f).size() == 3;
        facets += mesh.facet_count();
    }
    CHECK(static_cast<double>(triangles) < 0.28 * static_cast<double>(facets));
}

TEST_CASE("whatever the normals, crossings, joins and chains alone make an oriented 2-manifold",
          "[contour][slow]") {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) check_unaided(seed, 8000, 0.1);
}

TEST_CASE("whatever the normals of a small cloud, an oriented 2-manifold comes out unaided", "[contour]") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) check_unaided(seed, 2000, 0.2);
}

TEST_CASE("the extended facets do not depend on the number of threads", "[contour]") {
    const PointCloud cloud = scan(support::mechanical_part(support::random_pose(1)), 60000);
    const DualContour many = facets_of(cloud, 0.1);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const DualContour single = facets_of(cloud, 0.1);
    CHECK(many.mesh.positions == single.mesh.positions);
    CHECK(many.mesh.corners == single.mesh.corners);
    CHECK(many.classes == single.classes);
}

TEST_CASE("the extended graph has the facets' edges, each with its twin", "[contour]") {
    const DualContour facets = facets_of(scan(support::sphere(1), 20000), 0.125);
    const ConnectivityGraph graph = extended_graph(facets.mesh, facets.voxel);
    CHECK(graph.vertex_count() == facets.mesh.vertex_count());
    CHECK(graph.half_edge_count() == 2 * measure_topology(facets.mesh).edges);
    for (Index h = 0; h < graph.half_edge_count(); ++h) CHECK(graph.twin[graph.twin[h]] == h);
}
