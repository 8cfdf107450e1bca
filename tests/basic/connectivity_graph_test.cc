#include "hsdm/basic/connectivity_graph.hh"
#include "hsdm/basic/voxel_centroid.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

using namespace hsdm;

namespace {

/// One point in the middle of each given voxel of an 8 x 8 x 8 grid, and two that pin down its cube.
PointCloud centers(std::vector<VoxelCoord> voxels) {
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}, {8, 8, 8}};
    for (const VoxelCoord& v : voxels) cloud.positions.emplace_back(v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
    return cloud;
}

PointCloud graph_cloud(std::size_t n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gauss;
    PointCloud cloud;
    for (std::size_t i = 0; i < n; ++i)
        cloud.positions.push_back(Vec3(gauss(random), gauss(random), gauss(random)).normalized()
                                  + Vec3(7, 8, 9));
    return cloud;
}

bool joined(const ConnectivityGraph& graph, const OctreeLevel& level, VoxelCoord a, VoxelCoord b) {
    return graph.find(level.find(a), level.find(b)) != no_index;
}

} // namespace

TEST_CASE("a vertex lies at the centroid of its voxel's points", "[basic]") {
    PointCloud cloud = centers({});
    cloud.positions.insert(cloud.positions.end(), {{4.25, 4.5, 4.5}, {4.75, 4.5, 4.75}, {4.5, 4.5, 4.25}});
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 3);
    const Vec3 p = voxel_centroid(octree, level, level.find(VoxelCoord{4, 4, 4})) + octree.origin;
    CHECK((p - Vec3(4.5, 4.5, 4.5)).norm() < 1e-15);
}

TEST_CASE("the graph of a flat layer is its grid", "[basic]") {
    std::vector<VoxelCoord> layer;
    for (int x = 1; x < 7; ++x)
        for (int y = 1; y < 7; ++y) layer.push_back({x, y, 3});
    const Octree octree = build_octree(centers(layer));
    const OctreeLevel level = extract_level(octree, 3);
    const ConnectivityGraph graph = extract_graph(octree, level);
    CHECK(graph.half_edge_count() == 2 * 2 * 6 * 5);
    CHECK(joined(graph, level, {2, 2, 3}, {3, 2, 3}));
    CHECK_FALSE(joined(graph, level, {2, 2, 3}, {3, 3, 3}));
}

TEST_CASE("one choice makes an edge unless both ends are asked", "[basic]") {
    // (4,4,3) has one face neighbour and chooses (3,3,3) across the edge; (3,3,3) has four of its own.
    const std::vector<VoxelCoord> voxels{{3, 3, 3}, {2, 3, 3}, {3, 2, 3}, {3, 3, 2}, {3, 3, 4}, {4, 4, 3}};
    const Octree octree = build_octree(centers(voxels));
    const OctreeLevel level = extract_level(octree, 3);
    CHECK(joined(extract_graph(octree, level), level, {4, 4, 3}, {3, 3, 3}));
    CHECK(joined(extract_graph(octree, level), level, {3, 3, 3}, {4, 4, 3}));
    GraphOptions mutual;
    mutual.mutual = true;
    CHECK_FALSE(joined(extract_graph(octree, level, mutual), level, {4, 4, 3}, {3, 3, 3}));
    CHECK(joined(extract_graph(octree, level, mutual), level, {2, 3, 3}, {3, 3, 3}));
}

TEST_CASE("the graph is a doubly-connected edge list of the voxels", "[basic]") {
    const Octree octree = build_octree(graph_cloud(20000, 3));
    const OctreeLevel level = extract_level(octree, 4);
    const ConnectivityGraph graph = extract_graph(octree, level);
    REQUIRE(graph.vertex_count() == level.size());
    REQUIRE(graph.first_edge.back() == graph.half_edge_count());
    bool sound = true;
    for (Index v = 0; v < graph.vertex_count(); ++v) {
        sound &= graph.voxel[v] == v;
        for (Index h = graph.first_edge[v]; h < graph.first_edge[v + 1]; ++h) {
            const Index u = graph.end[h];
            sound &= u != v && graph.start(h) == v && graph.twin[graph.twin[h]] == h
                     && graph.end[graph.twin[h]] == v && (h == graph.first_edge[v] || graph.end[h - 1] < u)
                     && graph.find(v, u) == h;
            const VoxelCoord a = level.coord(v), b = level.coord(u);
            const int dx = std::abs(a[0] - b[0]), dy = std::abs(a[1] - b[1]), dz = std::abs(a[2] - b[2]);
            sound &= std::max({dx, dy, dz}) == 1 && dx + dy + dz <= 2;
        }
    }
    CHECK(sound);
    CHECK(graph.find(0, 0) == no_index);
}

TEST_CASE("the graph does not depend on threads or on the order of the points", "[basic]") {
    PointCloud cloud = graph_cloud(200000, 4);
    const Octree octree = build_octree(cloud);
    const ConnectivityGraph graph = extract_graph(octree, extract_level(octree, 7));
    std::shuffle(cloud.positions.begin(), cloud.positions.end(), std::mt19937_64(5));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Octree shuffled = build_octree(cloud);
    const ConnectivityGraph again = extract_graph(shuffled, extract_level(shuffled, 7));
    CHECK(graph.positions == again.positions);
    CHECK(graph.first_edge == again.first_edge);
    CHECK(graph.end == again.end);
    CHECK(graph.twin == again.twin);
}

TEST_CASE("neighbour options out of range are refused", "[basic]") {
    const Octree octree = build_octree(graph_cloud(100, 6));
    const OctreeLevel level = extract_level(octree, 2);
    GraphOptions options;
    options.neighbors.wanted = 0;
    CHECK_THROWS_AS(extract_graph(octree, level, options), OptionError);
    options.neighbors.wanted = 4;
    options.neighbors.max_face_neighbors = 3;
    CHECK_THROWS_AS(extract_graph(octree, level, options), OptionError);
}
