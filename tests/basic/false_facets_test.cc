#include "hsdm/basic/false_facets.hh"

#include <catch2/catch.hpp>

#include <numbers>

using namespace hsdm;

namespace {

/// Points in voxels of an 8 x 8 x 8 grid of edge 1; two more points pin down its cube.
struct Scene {
    Octree octree;
    OctreeLevel level;
    ConnectivityGraph graph;

    explicit Scene(const std::vector<Vec3>& points) {
        PointCloud cloud;
        cloud.positions = points;
        cloud.positions.insert(cloud.positions.end(), {{0, 0, 0}, {8, 8, 8}});
        octree = build_octree(cloud);
        level = extract_level(octree, 3);
        graph = extract_graph(octree, level);
    }
    std::vector<Index> at(std::initializer_list<VoxelCoord> voxels) const {
        std::vector<Index> vertices;
        for (const VoxelCoord& v : voxels) vertices.push_back(level.find(v));
        return vertices;
    }
};

Vec3 center(const VoxelCoord& v) {
    return {v[0] + 0.5, v[1] + 0.5, v[2] + 0.5};
}

std::vector<Vec3> centers(std::initializer_list<VoxelCoord> voxels) {
    std::vector<Vec3> points;
    for (const VoxelCoord& v : voxels) points.push_back(center(v));
    return points;
}

const std::initializer_list<VoxelCoord> floor_quad{{2, 2, 2}, {3, 2, 2}, {3, 3, 2}, {2, 3, 2}};

} // namespace

TEST_CASE("the area vector points along the normal that the order of the vertices gives", "[false facets]") {
    const Scene scene(centers(floor_quad));
    CHECK((facet_area(scene.graph, scene.at(floor_quad)) - Vec3(0, 0, 1)).norm() < 1e-12);
    CHECK((facet_area(scene.graph, scene.at({{2, 3, 2}, {3, 3, 2}, {3, 2, 2}, {2, 2, 2}})) - Vec3(0, 0, -1))
              .norm()
          < 1e-12);
}

TEST_CASE("a facet hits a neighbouring voxel before it, not one behind it or beyond the neighbours",
          "[false facets]") {
    std::vector<Vec3> points = centers(floor_quad);
    points.push_back(Vec3(2.9, 2.9, 3.5)); // over the corner that the four voxels share
    CHECK_FALSE(hits_neighbor_voxel(Scene(centers(floor_quad)).level, Scene(centers(floor_quad)).graph,
                                    Scene(centers(floor_quad)).at(floor_quad)));
    points[0] -= Vec3(0.2, 0.2, 0); // so that the ray rises through voxel (2, 2, 3)
    const Scene covered(points);
    const std::vector<Index> up = covered.at(floor_quad);
    CHECK(hits_neighbor_voxel(covered.level, covered.graph, up));
    CHECK_FALSE(
        hits_neighbor_voxel(covered.level, covered.graph, std::vector<Index>(up.rbegin(), up.rend())));
    points.back()[2] += 1; // one voxel higher: no neighbour any more
    const Scene high(points);
    CHECK_FALSE(hits_neighbor_voxel(high.level, high.graph, high.at(floor_quad)));
}

TEST_CASE("the deviation is that of the farthest point in the voxels a facet passes", "[false facets]") {
    std::vector<Vec3> points = centers(floor_quad);
    // Two more points above and below one centre leave it where it is; a third lies in no voxel of the facet.
    points.insert(points.end(), {{2.5, 2.5, 2.9}, {2.5, 2.5, 2.1}, {2.5, 2.5, 3.4}});
    const Scene scene(points);
    const double deviation =
        deviation_from_close_points(scene.octree, scene.level, scene.graph, scene.at(floor_quad));
    CHECK(deviation == Approx(0.4));
}

TEST_CASE("the facet through the points deviates less than the one that cuts across", "[false facets]") {
    // A step: floor, riser and upper floor; the false facet bridges the step under the points of its edge.
    std::vector<Vec3> points = centers({{2, 2, 2}, {2, 3, 2}, {3, 2, 2}, {3, 3, 2}, {3, 2, 3}, {3, 3, 3}});
    points.insert(points.end(), {{2.5, 2.5, 2.6}, {2.5, 2.5, 2.4}});
    const Scene scene(points);
    const auto deviation = [&](std::initializer_list<VoxelCoord> facet) {
        return deviation_from_close_points(scene.octree, scene.level, scene.graph, scene.at(facet));
    };
    CHECK(deviation({{2, 2, 2}, {3, 2, 2}, {3, 3, 2}, {2, 3, 2}})
          < deviation({{2, 2, 2}, {3, 2, 3}, {3, 3, 3}, {2, 3, 2}}));
}

TEST_CASE("the outer of two candidates has the smaller angle", "[false facets]") {
    const Scene scene(centers({{2, 2, 2},
                               {3, 2, 2},
                               {3, 3, 2},
                               {2, 3, 2},
                               {4, 2, 2},
                               {4, 3, 2},
                               {3, 2, 3},
                               {3, 3, 3},
                               {3, 2, 1},
                               {3, 3, 1}}));
    const std::vector<Index> previous = scene.at(floor_quad); // faces up, runs along (3,2,2) -> (3,3,2)
    const auto angle = [&](std::initializer_list<VoxelCoord> facet) {
        return outer_angle(scene.graph, scene.level.find(VoxelCoord{3, 3, 2}),
                           scene.level.find(VoxelCoord{3, 2, 2}), previous, scene.at(facet));
    };
    const double pi = std::numbers::pi;
    CHECK(angle({{3, 3, 2}, {3, 2, 2}, {3, 2, 3}, {3, 3, 3}}) == Approx(pi / 2));
    CHECK(angle({{3, 3, 2}, {3, 2, 2}, {4, 2, 2}, {4, 3, 2}}) == Approx(pi));
    CHECK(angle({{3, 3, 2}, {3, 2, 2}, {3, 2, 1}, {3, 3, 1}}) == Approx(3 * pi / 2));
    CHECK(angle({{3, 3, 2}, {3, 2, 2}, {2, 2, 2}, {2, 3, 2}}) == Approx(2 * pi)); // folded back: last of all
}
