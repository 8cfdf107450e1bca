// Vertices reach points that stand out from the facets, if these are a surface.
#include "contour/stages.hh"

#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/reach.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "support/check.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numeric>
#include <set>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// A mesh of a cloud, relative to the octree's origin, as dual_contour leaves it.
struct Unreached {
    Stages stages;
    DualContour part;
    std::vector<Index> voxels; // all

    explicit Unreached(const PointCloud& cloud) : stages(cloud, 4) {
        part = dual_contour(stages.octree, stages.level, stages.sets);
        part.mesh.origin.resize(part.mesh.vertex_count());
        std::iota(part.mesh.origin.begin(), part.mesh.origin.end(), Index{0});
        voxels.resize(stages.level.size());
        std::iota(voxels.begin(), voxels.end(), Index{0});
    }
    std::size_t reach(PolygonMesh& mesh) const {
        return reach_points(stages.octree, stages.level, part.voxel, voxels, mesh);
    }
    /// Points farther than that from a mesh, in voxels.
    std::ptrdiff_t beyond(double far, const PolygonMesh& mesh) const {
        const MeshDistance distance(mesh);
        return std::ranges::count_if(stages.octree.positions,
                                     [&](const Vec3& p) { return distance(p) > far * stages.h(); });
    }
};

PointCloud ball(std::size_t points) {
    return sample(sphere(1), {.points = points, .seed = 1});
}

} // namespace

TEST_CASE("a dent is drawn out to the points, and nothing moves elsewhere", "[contour]") {
    const Unreached made(ball(40000));
    const PolygonMesh& smooth = made.part.mesh;
    PolygonMesh mesh = smooth;
    CHECK(made.reach(mesh) == 0);
    CHECK(mesh.positions == smooth.positions);

    const Index pushed = smooth.facet(smooth.facet_count() / 2)[0];
    const Vec3 middle = -made.stages.octree.origin; // of the sphere
    mesh.positions[pushed] -= (mesh.positions[pushed] - middle).normalized() * (0.8 * made.stages.h());
    REQUIRE(made.beyond(0.3, mesh) > 3);
    PolygonMesh again = mesh;
    CHECK(made.reach(mesh) > 0);
    CHECK(made.beyond(0.3, mesh) < 3);
    std::set<Index> dent;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (std::ranges::find(mesh.facet(f), pushed) != mesh.facet(f).end())
            dent.insert(mesh.facet(f).begin(), mesh.facet(f).end());
    for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (!dent.contains(v)) CHECK(mesh.positions[v] == smooth.positions[v]);
    CHECK(mesh.corners == smooth.corners);

    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    made.reach(again);
    CHECK(again.positions == mesh.positions);
}

TEST_CASE("strays beside a surface are not reached", "[contour]") {
    PointCloud cloud = ball(8000); // nine a voxel face
    const double voxel = Unreached(cloud).stages.h();
    for (const double height : {0.9, 1.0, 1.1, 1.2}) { // more than are asked for, on one another
        cloud.positions.push_back(Vec3(0, 0, 1 + height * voxel));
        cloud.normals.push_back(Vec3(0, 0, 1));
    }
    const Unreached made(cloud);
    REQUIRE(made.beyond(0.4, made.part.mesh) > 2);
    PolygonMesh mesh = made.part.mesh;
    CHECK(made.reach(mesh) == 0);
    CHECK(mesh.positions == made.part.mesh.positions);
}
