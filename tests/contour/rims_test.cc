#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double size_of_voxel = 1.0 / 16;

PolygonMesh facets_of_scan(const PointCloud& cloud) {
    return to_polygons(reconstruct(cloud, {.voxel_size = size_of_voxel}).mesh);
}

} // namespace

TEST_CASE("a thin plate ends less than a voxel from where it should", "[contour][accuracy]") {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
        for (const double width : {0.25, 0.5}) {
            INFO(width << ", seed " << seed);
            const Solid plate = box({1, 0.8, width * size_of_voxel}).placed(random_pose(seed));
            const PolygonMesh mesh = facets_of_scan(sample(plate, {.points = 5000, .seed = seed}));
            CHECK(farthest_vertex(mesh, plate) < size_of_voxel);
        }
}
