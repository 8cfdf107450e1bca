#include "hsdm/contour/dual_contour.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/simplify/simplify.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;
using support::faults;

namespace {

/// Of a fillet along x, in its own pose.
struct Rows {
    std::size_t quads = 0;   ///< with two corners at either end
    double area = 0;         ///< of the fillet
    double area_of_rows = 0; ///< of those quads
};

Rows rows_of(const PolygonMesh& mesh, const support::Pose& pose) {
    constexpr double off_tangent = 0.1; // sine: facets that face nearly as the flat ground does are its own
    constexpr double end = 0.995;       // of the block, from its middle
    Rows rows;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        const Vec3 area = pose.unrotate(area_vector(mesh, ring)), n = unit(area);
        if (std::abs(n[0]) > 0.5 || std::min(n[1], n[2]) < off_tangent) continue;
        rows.area += area.norm();
        std::size_t left = 0, right = 0;
        for (Index v : ring) {
            const double x = pose.to_local(mesh.positions[v])[0];
            left += x < -end;
            right += x > end;
        }
        if (ring.size() != 4 || left != 2 || right != 2) continue;
        rows.area_of_rows += area.norm();
        ++rows.quads;
    }
    return rows;
}

/// A person's: quarters of circles as chords that miss them by the error.
std::size_t chords(double radius, double error) {
    return static_cast<std::size_t>(std::ceil(std::numbers::pi / 2 / std::sqrt(8 * error / radius)));
}

struct Part {
    Octree octree;
    AdaptiveMesh coarse;
    double error;
};

/// The finest voxels are 1/64 of the cube; the error is a share of the bounding box's diagonal.
Part coarse_part(const support::Solid& solid, const support::SampleOptions& options, double share) {
    constexpr int depth = 6;
    Part part{build_octree(support::sample(solid, options)), {}, 0};
    const OctreeLevel level = extract_level(part.octree, depth);
    DualContourOptions how;
    how.better_quads = false; // as for every adaptive grid
    const PolygonMesh fine =
        dual_contour(part.octree, level, build_normal_sets(part.octree, level), how).mesh;
    part.error = share * part.octree.bounds.diagonal();
    part.coarse = simplify(fine, part.octree.positions, part.octree.extent, depth, {.max_error = part.error});
    for (Vec3& p : part.coarse.mesh.positions) p += part.octree.origin;
    return part;
}

} // namespace

TEST_CASE("a fillet is a row of quads from end to end, in any pose", "[pipeline][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        double radius, share;
        std::size_t most_faces; // in the mean
        double noise = 0;
    };
    const std::vector<Example> examples = {
        {"radius 0.1", support::rounded_block(0.1), 0.1, 0.002, 14},
        {"radius 0.2", support::rounded_block(0.2), 0.2, 0.002, 16},
        {"radius 0.2, half the error", support::rounded_block(0.2), 0.2, 0.001, 20},
        {"radius 0.35", support::rounded_block(0.35), 0.35, 0.002, 20},
        {"radius 0.35, half the error", support::rounded_block(0.35), 0.35, 0.001, 24},
        {"radius 0.35 with noise", support::rounded_block(0.35), 0.35, 0.002, 24, 0.001},
        {"radius 0.5, half the error", support::rounded_block(0.5), 0.5, 0.001, 36},
        {"radius 0.8", support::rounded_block(0.8), 0.8, 0.002, 24},
        {"hollow, radius 0.3", support::hollow_step(0.3, 0.5), 0.3, 0.002, 28},
        {"hollow, radius 0.3, half the error", support::hollow_step(0.3, 0.5), 0.3, 0.001, 34},
    };
    constexpr std::uint64_t poses = 4;
    for (const Example& e : examples) {
        std::size_t faces = 0;
        double area = 0, area_of_rows = 0;
        for (std::uint64_t seed = 1; seed <= poses; ++seed) {
            INFO(e.name << ", seed " << seed);
            support::Random random(seed);
            const support::Pose pose = support::random_pose(random);
            const Part part = coarse_part(
                e.solid.placed(pose),
                {.points = 40000, .seed = seed, .position_noise = e.noise, .normal_noise = 10 * e.noise},
                e.share);
            const PolygonMesh& mesh = part.coarse.mesh;
            CHECK(faults(mesh) == "");
            CHECK(measure_topology(mesh).euler == 2);
            CHECK(part.coarse.points_beyond == part.coarse.unreachable);
            const Rows rows = rows_of(mesh, pose);
            CHECK(rows.quads > 1);
            CHECK(rows.quads <= chords(e.radius, part.error));
            CHECK(rows.area_of_rows >= 0.5 * rows.area); // strips may end in triangles
            area += rows.area;
            area_of_rows += rows.area_of_rows;
            faces += mesh.facet_count();
        }
        INFO(e.name);
        CHECK(area_of_rows >= 0.9 * area);
        CHECK(faces <= poses * e.most_faces);
    }
}

TEST_CASE("a shaft is a row of quads round its axis", "[pipeline][slow]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        INFO("seed " << seed);
        support::Random random(seed);
        const support::Pose pose = support::random_pose(random);
        const support::Pose along_x = support::turned({0, 1, 0}, std::numbers::pi / 2);
        const Part part = coarse_part(support::cylinder(0.5, 2).placed(support::compose(pose, along_x)),
                                      {.points = 30000, .seed = seed}, 0.002);
        const PolygonMesh& mesh = part.coarse.mesh;
        CHECK(faults(mesh) == "");
        CHECK(measure_topology(mesh).euler == 2);
        CHECK(rows_of(mesh, pose).quads >= 3); // of the quarter of directions that it looks at
        CHECK(rows_of(mesh, pose).area_of_rows >= 0.9 * rows_of(mesh, pose).area);
        CHECK(mesh.facet_count() <= 60);
    }
}
