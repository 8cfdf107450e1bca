#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;
using namespace hsdm::support;

namespace {

constexpr double size_of_voxel = 1.0 / 16;

PolygonMesh facets_of_scan(const PointCloud& cloud) {
    return to_polygons(reconstruct(cloud, {.voxel_size = size_of_voxel}).mesh);
}

} // namespace

TEST_CASE("the ends of sharp edges do not stand out from the solid", "[contour][accuracy]") {
    struct Wedge {
        double degrees;
        std::uint64_t seed;
        double most; // voxels
    };
    // Poses in which the end face has no points in the edge's last voxel: 0.4 to 0.88 when rims alone were
    // drawn in.
    for (const auto& [degrees, seed, most] :
         {Wedge{8, 15, 0.6}, {8, 16, 0.3}, {8, 28, 0.3}, {12, 23, 0.3}, {12, 28, 0.3}, {20, 36, 0.6}}) {
        INFO(degrees << " degrees, seed " << seed);
        const double angle = degrees * std::numbers::pi / 180;
        const double c = std::cos(angle), s = std::sin(angle);
        const Pose above =
            turned({0, 0, 1}, angle, Vec3(0.6 * c - 0.3 * s - 0.4, 0.6 * s + 0.3 * c - 0.25, 0));
        const Solid wedge =
            (box({0.8, 0.5, 0.6}) - box({1.4, 0.6, 0.8}).placed(above)).placed(random_pose(seed));
        const PolygonMesh mesh = facets_of_scan(sample(wedge, {.points = 3000, .seed = seed}));
        CHECK(measure_topology(mesh).euler == 2);
        CHECK(farthest_vertex(mesh, wedge) < most * size_of_voxel);
    }
}

TEST_CASE("a thin plate ends less than a voxel from where it should", "[contour][accuracy]") {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
        for (const double width : {0.25, 0.5}) {
            INFO(width << ", seed " << seed);
            const Solid plate = box({1, 0.8, width * size_of_voxel}).placed(random_pose(seed));
            const PolygonMesh mesh = facets_of_scan(sample(plate, {.points = 5000, .seed = seed}));
            CHECK(farthest_vertex(mesh, plate) < size_of_voxel);
        }
}
