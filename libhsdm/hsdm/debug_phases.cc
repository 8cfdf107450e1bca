#include "hsdm/debug_phases.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/write_mesh.hh"

#include <charconv>
#include <filesystem>

namespace hsdm {
namespace {

std::string file_in(const std::string& folder, const std::string& phase, int depth, const char* extension) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(folder, "the folder cannot be made: " + error.message());
    return (std::filesystem::path(folder) / (phase + ".d" + std::to_string(depth) + extension)).string();
}

/// The four corners of each face of a cube whose corner i lies at (i & 1, i >> 1 & 1, i >> 2), outward.
constexpr std::array<std::array<Index, 4>, 6> cube_faces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

} // namespace

void write_debug_voxels(const std::string& folder, const Octree& octree, const OctreeLevel& level) {
    PolygonMesh cubes;
    cubes.positions.reserve(8 * level.size());
    for (Index v = 0; v < level.size(); ++v) {
        const VoxelCoord c = level.coord(v);
        for (int i = 0; i < 8; ++i)
            cubes.positions.push_back(octree.origin
                                      + Vec3(c[0] + (i & 1), c[1] + (i >> 1 & 1), c[2] + (i >> 2))
                                            * level.voxel_size);
        for (std::array<Index, 4> face : cube_faces) {
            for (Index& corner : face) corner += 8 * v;
            cubes.add_facet(face);
        }
    }
    write_mesh(file_in(folder, "voxels", level.depth, ".obj"), cubes, MeshFormat::obj);
}

void write_debug_graph(const std::string& folder, const Octree& octree, const OctreeLevel& level,
                       const ConnectivityGraph& graph) {
    std::string text;
    const auto append = [&text](auto value) {
        char digits[32];
        text += ' ';
        text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    };
    for (const Vec3& relative : graph.positions) {
        const Vec3 p = relative + octree.origin;
        text += 'v';
        for (unsigned k = 0; k < 3; ++k) append(p[k]);
        text += '\n';
    }
    for (Index h = 0; h < graph.half_edge_count(); ++h) {
        if (graph.start(h) > graph.end[h]) continue;
        text += 'l';
        append(graph.start(h) + 1);
        append(graph.end[h] + 1);
        text += '\n';
    }
    write_text(file_in(folder, "graph", level.depth, ".obj"), text);
}

void write_debug_facets(const std::string& folder, const OctreeLevel& level, const PolygonMesh& facets) {
    write_mesh(file_in(folder, "facets", level.depth, ".off"), facets, MeshFormat::off);
}

} // namespace hsdm
