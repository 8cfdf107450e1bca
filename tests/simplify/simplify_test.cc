#include "hsdm/contour/dual_contour.hh"
#include "hsdm/errors.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/simplify/simplify.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <array>
#include <map>
#include <numbers>

using namespace hsdm;
using support::faults;

namespace {

struct Fine {
    Octree octree;
    PolygonMesh mesh; // relative to the octree's origin
    int depth;
};

Fine fine_mesh(const support::Solid& solid, std::size_t points, int depth) {
    Fine fine{build_octree(support::sample(solid, {.points = points})), {}, depth};
    const OctreeLevel level = extract_level(fine.octree, depth);
    fine.mesh = dual_contour(fine.octree, level, build_normal_sets(fine.octree, level)).mesh;
    return fine;
}

AdaptiveMesh coarse(const Fine& fine, double max_error) {
    return simplify(fine.mesh, fine.octree.positions, fine.octree.extent, fine.depth,
                    {.max_error = max_error});
}

} // namespace

TEST_CASE("coarse meshes are closed 2-manifolds of the fine one's topology within the error",
          "[simplify][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        int depth;
        double most_faces; // of the fine mesh's
    };
    const std::vector<Example> examples = {
        {"sphere", support::sphere(1), 5, 0.3},
        {"torus", support::torus(1, 0.35), 5, 0.6},
        {"box", support::box({1, 1.3, 0.8}).placed(support::random_pose(3)), 5, 0.3},
        {"plate", support::box({1, 0.7, 0.03}).placed(support::random_pose(4)), 5, 0.7},
        {"mechanical part", support::mechanical_part(support::random_pose(5)), 5, 0.5},
    };
    for (const Example& e : examples) {
        const Fine fine = fine_mesh(e.solid, 40000, e.depth);
        const Topology before = measure_topology(fine.mesh);
        for (double share : {0.002, 0.01}) {
            INFO(e.name << ", error " << share << " of the extent");
            const double error = share * fine.octree.extent;
            const AdaptiveMesh result = coarse(fine, error);
            const Topology after = measure_topology(result.mesh);
            CHECK(faults(result.mesh) == "");
            CHECK(after.closed());
            CHECK(after.euler == before.euler);
            CHECK(after.components == before.components);
            CHECK(find_self_intersections(result.mesh).triangle_pairs
                  <= find_self_intersections(fine.mesh).triangle_pairs);
            CHECK(result.points_beyond == result.unreachable);
            CHECK(points_to_mesh(fine.mesh.positions, result.mesh).max <= 2 * error);
            CHECK(points_to_mesh(result.mesh.positions, fine.mesh).max <= error);
            if (share == 0.01)
                CHECK(static_cast<double>(after.faces) <= e.most_faces * static_cast<double>(before.faces));
        }
    }
}

TEST_CASE("a vertex that only two facets of the fine mesh have stays where they would pass through something "
          "as one",
          "[simplify]") {
    // The top of a cube is two facets round a vertex far below it, and a tetrahedron stands out of the
    // hollow.
    PolygonMesh fine = support::mesh_of(
        support::cube_corners(),
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 8}, {8, 7, 6, 4}});
    fine.positions.emplace_back(0.5, 0.5, 0.4);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(0, 0, 0.5)})
        fine.positions.push_back(Vec3(0.45, 0.48, 0.7) + p);
    for (const auto& f : {std::array<Index, 3>{9, 11, 10}, {9, 10, 12}, {10, 11, 12}, {11, 9, 12}})
        fine.add_facet(f);
    REQUIRE(find_self_intersections(fine).facet_pairs.empty());
    REQUIRE(faults(fine) == "");
    std::vector<Vec3> points = fine.positions;
    points.erase(points.begin() + 8); // with it the whole fine mesh would be the result
    const AdaptiveMesh result = simplify(fine, points, 2, 5, {.max_error = 1e-3});
    CHECK(find_self_intersections(result.mesh).facet_pairs.empty());
    CHECK(result.intersecting == 0);
    CHECK(faults(result.mesh) == "");
    CHECK(result.points_beyond == 0);
    CHECK(std::ranges::find(result.mesh.positions, fine.positions[8]) != result.mesh.positions.end());
}

TEST_CASE("leaves, levels and vertices belong to the mesh", "[simplify]") {
    const Fine fine = fine_mesh(support::mechanical_part(), 40000, 5);
    const AdaptiveMesh result = coarse(fine, 0.005 * fine.octree.extent);
    REQUIRE(result.vertex.size() == fine.mesh.vertex_count());
    REQUIRE(result.level.size() == result.mesh.vertex_count());
    REQUIRE(result.leaves_per_level.size() == 6);
    std::size_t leaves = 0;
    for (std::size_t n : result.leaves_per_level) leaves += n;
    CHECK(leaves <= result.mesh.vertex_count() + result.merged);
    std::vector<std::uint8_t> seen(result.mesh.vertex_count(), 0);
    for (std::size_t v = 0; v < result.vertex.size(); ++v) {
        const Index coarse = result.vertex[v];
        if (coarse == no_index) continue;
        REQUIRE(coarse < seen.size());
        seen[coarse] = 1;
        const double leaf = fine.octree.extent / static_cast<double>(1u << result.level[coarse]);
        CHECK((result.mesh.positions[coarse] - fine.mesh.positions[v]).norm() < 2 * leaf);
    }
    CHECK(std::count(seen.begin(), seen.end(), 0) == 0);
}

TEST_CASE("an axis-parallel box becomes as few quads as its corners allow", "[simplify]") {
    const Fine fine = fine_mesh(support::box({1, 1, 1}), 30000, 4);
    const AdaptiveMesh result = coarse(fine, 0.02 * fine.octree.extent);
    CHECK(result.mesh.facet_count() <= 24);
    CHECK(measure_topology(result.mesh).euler == 2);
}

TEST_CASE("sparse boxes in general pose have sharp corners and take few facets", "[simplify][accuracy]") {
    constexpr std::uint64_t poses = 20;
    std::size_t facets = 0, blunt = 0;
    for (std::uint64_t seed = 1; seed <= poses; ++seed) {
        INFO("seed " << seed);
        const Fine fine = fine_mesh(support::box({1, 1, 1}).placed(support::random_pose(seed)), 5000, 4);
        const double voxel = fine.octree.voxel_size(4);
        const double farthest = points_to_mesh(fine.octree.positions, fine.mesh).max;
        CHECK(farthest < 0.3 * voxel);
        blunt += farthest > 0.05 * voxel;
        CHECK(faults(fine.mesh) == "");
        const AdaptiveMesh result = coarse(fine, 0.002 * fine.octree.bounds.diagonal());
        CHECK(faults(result.mesh) == "");
        CHECK(measure_topology(result.mesh).euler == 2);
        facets += result.mesh.facet_count();
    }
    CHECK(blunt <= 1);
    CHECK(facets <= 15 * poses);
}

TEST_CASE("plates and wedges and rods in general pose and a shaft take few facets", "[simplify][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        std::size_t most_faces;
    };
    const std::vector<Example> examples = {
        {"plate of a twentieth", support::box({1, 1, 0.05}).placed(support::random_pose(6)), 20},
        {"plate of a fiftieth", support::box({1, 1, 0.02}).placed(support::random_pose(7)), 50},
        {"rod", support::box({1, 0.06, 0.06}).placed(support::random_pose(8)), 25},
        {"wedge", support::wedge(0.5, 1, 1).placed(support::random_pose(9)), 80},
        {"shaft", support::cylinder(0.5, 2), 150},
    };
    for (const Example& e : examples) {
        INFO(e.name);
        const Fine fine = fine_mesh(e.solid, 40000, 6);
        const AdaptiveMesh result = coarse(fine, 0.003 * fine.octree.extent);
        CHECK(faults(result.mesh) == "");
        CHECK(measure_topology(result.mesh).euler == measure_topology(fine.mesh).euler);
        CHECK(result.mesh.facet_count() <= e.most_faces);
        CHECK(fine.mesh.facet_count() > 5 * e.most_faces);
    }
}

TEST_CASE("sides at a border stay near the fine surface's", "[simplify]") {
    // A flat ring: chords of its inner border lie off it.
    constexpr Index rings = 17, spokes = 256;
    PolygonMesh ring;
    for (Index r = 0; r < rings; ++r)
        for (Index s = 0; s < spokes; ++s) {
            const double turn = 2 * std::numbers::pi * s / spokes, radius = 1 + r / 16.0;
            ring.positions.emplace_back(2.1 + radius * std::cos(turn), 2.1 + radius * std::sin(turn), 0.7);
        }
    for (Index r = 0; r + 1 < rings; ++r)
        for (Index s = 0; s < spokes; ++s) {
            const Index next = (s + 1) % spokes, in = r * spokes, out = in + spokes;
            ring.add_facet(std::array{in + s, out + s, out + next, in + next});
        }
    const MeshDistance to_fine(ring);
    for (double error : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
        INFO("error " << error);
        const PolygonMesh mesh = simplify(ring, {}, 4.2, 6, {.max_error = error}).mesh;
        CHECK(4 * mesh.facet_count() < ring.facet_count());
        std::map<std::array<Index, 2>, int> sides;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto facet = mesh.facet(f);
            for (std::size_t i = 0; i < facet.size(); ++i) {
                const Index a = facet[i], b = facet[(i + 1) % facet.size()];
                ++sides[{std::min(a, b), std::max(a, b)}];
            }
        }
        std::size_t borders = 0;
        for (const auto& [side, facets] : sides) {
            if (facets != 1) continue;
            ++borders;
            CHECK(to_fine(0.5 * (mesh.positions[side[0]] + mesh.positions[side[1]])) <= error);
        }
        CHECK(borders > 6);
    }
}

TEST_CASE("points that the fine mesh does not miss are never missed", "[simplify][slow]") {
    // Cells far smaller than facets: a point may have none in its own nor around.
    const Fine fine = fine_mesh(support::torus(1, 0.35), 40000, 4);
    for (double share : {0.001, 0.004, 0.02}) {
        INFO("error " << share << " of the extent");
        const AdaptiveMesh result = simplify(fine.mesh, fine.octree.positions, fine.octree.extent, 9,
                                             {.max_error = share * fine.octree.extent});
        CHECK(result.points_beyond == result.unreachable);
        CHECK(faults(result.mesh) == "");
        const MeshDistance to_fine(fine.mesh), to_result(result.mesh);
        std::size_t missed = 0, beyond = 0;
        for (const Vec3& p : fine.octree.positions) {
            missed += to_fine(p) > share * fine.octree.extent;
            beyond += to_result(p) > share * fine.octree.extent;
        }
        CHECK(beyond == result.points_beyond);
        CHECK(beyond <= missed);
    }
}

TEST_CASE("if the rounds do not suffice the fine mesh comes out", "[simplify]") {
    const Fine fine = fine_mesh(support::mechanical_part(support::random_pose(2)), 40000, 5);
    const AdaptiveMesh result = simplify(fine.mesh, fine.octree.positions, fine.octree.extent, fine.depth,
                                         {.max_error = 0.002 * fine.octree.extent, .rounds = 1});
    CHECK(result.mesh.facet_count() == fine.mesh.facet_count());
    CHECK(faults(result.mesh) == "");
    CHECK(result.points_beyond == result.unreachable);
}

TEST_CASE("coarsening does not depend on the number of threads", "[simplify]") {
    const Fine fine = fine_mesh(support::mechanical_part(support::random_pose(2)), 40000, 5);
    const AdaptiveMesh many = coarse(fine, 0.003 * fine.octree.extent);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const AdaptiveMesh single = coarse(fine, 0.003 * fine.octree.extent);
    CHECK(many.mesh.positions == single.mesh.positions);
    CHECK(many.mesh.corners == single.mesh.corners);
    CHECK(many.vertex == single.vertex);
}

TEST_CASE("errors and rounds out of range are refused", "[simplify]") {
    const PolygonMesh none;
    CHECK_THROWS_AS(simplify(none, {}, 1, 4, {.max_error = 0}), OptionError);
    CHECK_THROWS_AS(simplify(none, {}, 1, 4, {.max_error = 1, .rounds = 0}), OptionError);
    CHECK(simplify(none, {}, 1, 4, {.max_error = 1}).mesh.facet_count() == 0);
}
