#include "hsdm/contour/dual_contour.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

TEST_CASE("creases of a box are sharp between its corners", "[contour][accuracy]") {
    std::size_t off = 0, count = 0, clamped = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        INFO("seed " << seed);
        support::Random random(seed);
        const support::Pose pose = support::random_pose(random);
        const PointCloud cloud =
            support::sample(support::box({1, 1.2, 0.8}).placed(pose), {.points = 12000, .seed = seed});
        const Octree octree = build_octree(cloud);
        const OctreeLevel level = extract_level(octree, 5);
        const DualContour facets = dual_contour(octree, level, build_normal_sets(octree, level));
        CHECK(support::faults(facets.mesh) == "");
        CHECK(find_self_intersections(facets.mesh).triangle_pairs == 0);
        const MeshDistance distance(facets.mesh);
        for (const Vec3& p : octree.positions) off += distance(p) > 0.005 * level.voxel_size;
        count += octree.size();
        clamped += facets.clamped;
    }
    INFO(off << " of " << count << " points, " << clamped << " vertices clamped");
    CHECK(off * 1000 < count);
    CHECK(clamped > 0); // corners, and creases that pass close to other vertices
    CHECK(clamped < 12 * 50);
}
