// No vertex stands far out from the points.
#include "contour/stages.hh"

#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/spikes.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/neighbor_search.hh"
#include "support/crowded_parts.hh"
#include "support/pose.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numeric>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// A mesh of a cloud, relative to the octree's origin.
struct Made {
    Stages stages;
    DualContour part;

    Made(const Solid& solid, std::size_t points, int depth) : stages(solid, points, depth) {
        part = dual_contour(stages.octree, stages.level, stages.sets);
        part.mesh.origin.resize(part.mesh.vertex_count());
        std::iota(part.mesh.origin.begin(), part.mesh.origin.end(), Index{0});
    }
    std::size_t draw_in(PolygonMesh& mesh) const {
        return draw_in_spikes(stages.octree, stages.level, part.voxel, mesh);
    }
    /// To the nearest point, in voxels.
    double distance(const Vec3& place) const {
        double least = Box::inf;
        for (const Vec3& p : stages.octree.positions) least = std::min(least, (p - place).norm());
        return least / stages.h();
    }
};

} // namespace

TEST_CASE("spikes are drawn in to the points, and nothing else moves", "[contour]") {
    const Made made(sphere(1), 6000, 4);
    const PolygonMesh& smooth = made.part.mesh;
    PolygonMesh mesh = smooth;
    CHECK(made.draw_in(mesh) == 0);
    CHECK(mesh.positions == smooth.positions);

    // One vertex alone, and all of a facet elsewhere.
    std::vector<Index> pulled{smooth.facet(0)[0]};
    const auto facet = smooth.facet(smooth.facet_count() - 1);
    pulled.insert(pulled.end(), facet.begin(), facet.end());
    const Vec3 middle = -made.stages.octree.origin; // of the sphere
    for (const Index v : pulled)
        mesh.positions[v] += (mesh.positions[v] - middle).normalized() * (2.5 * made.stages.h());
    for (const Index v : pulled) REQUIRE(made.distance(mesh.positions[v]) > 2);
    const PolygonMesh spiky = mesh;
    CHECK(made.draw_in(mesh) == pulled.size());
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (std::ranges::find(pulled, v) != pulled.end())
            CHECK(made.distance(mesh.positions[v]) < 0.9);
        else
            CHECK(mesh.positions[v] == smooth.positions[v]);
    CHECK(mesh.corners == smooth.corners);

    PolygonMesh again = spiky;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    made.draw_in(again);
    CHECK(again.positions == mesh.positions);
}

TEST_CASE("where points are few only what is two spacings away from them is a spike", "[contour]") {
    const Made made(box({1, 1, 1}).placed(random_pose(2)), 300, 4);
    const PolygonMesh& before = made.part.mesh;
    PolygonMesh mesh = before;
    REQUIRE(5 * made.stages.octree.size() < 7 * made.stages.level.size()); // so a spacing is 0.85 voxels
    made.draw_in(mesh);
    int far = 0; // beyond what is a spike among many points
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const double distance = made.distance(before.positions[v]);
        far += distance > 0.9;
        if (distance < 1.1) CHECK(mesh.positions[v] == before.positions[v]);
    }
    CHECK(far > 10);
}

TEST_CASE("walls too thin for the sampling leave no vertex far away from all points", "[pipeline][slow]") {
    constexpr double voxel = 1.0 / 16, width = 0.32 * voxel;
    std::size_t drawn_in = 0;
    for (const Solid& solid : {can(width), heat_sink(width), honeycomb(width), roll(width)}) {
        const PointCloud cloud =
            sample(solid.placed(random_pose(1)), {.points = 40000, .seed = 1, .normals = false});
        const Reconstruction made = reconstruct(cloud, {.voxel_size = voxel});
        drawn_in += made.report.rejected.at("vertices_drawn_in");
        std::vector<Vec3> vertices;
        for (const auto v : made.mesh.vertices()) vertices.push_back(made.mesh.point(v));
        const NearPoints nearest = NeighborSearch(cloud.positions).nearest(vertices, 1);
        CHECK(*std::ranges::max_element(nearest.distance) < 1.25 * voxel); // untangled after that
    }
    CHECK(drawn_in > 10);
}
