#include "hsdm/pipeline/phase_geometry.hh"
#include "hsdm/quality/topology.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <random>
#include <sstream>

using namespace hsdm;

namespace {

PointCloud random_cloud() {
    std::mt19937_64 random(1);
    PointCloud cloud;
    for (int i = 0; i < 300; ++i)
        cloud.positions.emplace_back(double(random() % 1000), double(random() % 1000),
                                     double(random() % 300));
    return cloud;
}

} // namespace

TEST_CASE("voxels are drawn as closed cubes around their points", "[pipeline]") {
    const Octree octree = build_octree(random_cloud());
    const OctreeLevel level = extract_level(octree, 3);
    const PolygonMesh cubes = voxel_cubes(octree, level);
    const Topology topology = measure_topology(cubes);
    CHECK(topology.components == level.size());
    CHECK(topology.closed());
    CHECK(topology.signed_volume
          == Approx(static_cast<double>(level.size()) * std::pow(level.voxel_size, 3)));
    bool inside = true;
    for (Index v = 0; v < level.size(); ++v)
        for (Index p = level.first_point[v]; p < level.first_point[v + 1]; ++p) {
            const Vec3 q = octree.positions[p] + octree.origin;
            inside &= (q - cubes.positions[8 * v]).min() >= 0 && (cubes.positions[8 * v + 7] - q).min() >= 0;
        }
    CHECK(inside);
}

TEST_CASE("the graph is drawn as one line per edge", "[pipeline]") {
    const Octree octree = build_octree(random_cloud());
    const ConnectivityGraph graph = extract_graph(octree, extract_level(octree, 3));
    std::istringstream text(graph_obj(octree, graph));
    std::size_t vertices = 0, lines = 0;
    for (std::string line; std::getline(text, line);) {
        vertices += line.starts_with("v ");
        lines += line.starts_with("l ");
    }
    CHECK(vertices == graph.vertex_count());
    CHECK(2 * lines == graph.half_edge_count());
}

TEST_CASE("the phases are written into a folder", "[pipeline]") {
    const Octree octree = build_octree(random_cloud());
    const OctreeLevel level = extract_level(octree, 3);
    const support::Folder folder;
    write_phases(phase_files(folder / "deep", level.depth), octree, level, extract_graph(octree, level),
                 voxel_cubes(octree, level));
    for (const char* name : {"voxels.obj", "graph.obj", "facets.off"})
        CHECK(std::filesystem::file_size(folder / ("deep/d3/" + std::string(name))) > 0);
}
