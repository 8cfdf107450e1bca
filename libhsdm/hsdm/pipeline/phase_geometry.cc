#include "hsdm/pipeline/phase_geometry.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/write_mesh.hh"

#include <charconv>
#include <filesystem>

namespace hsdm {
namespace {

/// Corner i of a cube lies at x = bit 0, y = bit 1, z = bit 2.
constexpr std::array<std::array<Index, 4>, 6> cube_faces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

void append(std::string& text, double value) {
    std::array<char, 32> digits;
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

} // namespace

PolygonMesh voxel_cubes(const Octree& octree, const OctreeLevel& level, const CloudFrame& frame) {
    PolygonMesh mesh;
    for (Index v = 0; v < level.size(); ++v) {
        const VoxelCoord c = level.coord(v);
        for (int i = 0; i < 8; ++i)
            mesh.positions.push_back(frame.to_cloud(
                octree.origin
                + Vec3(c[0] + (i & 1), c[1] + (i >> 1 & 1), c[2] + (i >> 2)) * level.voxel_size));
        for (const auto& face : cube_faces)
            mesh.add_facet(std::array{8 * v + face[0], 8 * v + face[1], 8 * v + face[2], 8 * v + face[3]});
    }
    return mesh;
}

std::string graph_obj(const Octree& octree, const ConnectivityGraph& graph, const CloudFrame& frame) {
    std::string text;
    for (const Vec3& relative : graph.positions) {
        const Vec3 p = frame.to_cloud(relative + octree.origin);
        text += 'v';
        for (unsigned k = 0; k < 3; ++k) {
            text += ' ';
            append(text, p[k]);
        }
        text += '\n';
    }
    for (Index h = 0; h < graph.half_edge_count(); ++h)
        if (h < graph.twin[h])
            text += "l " + std::to_string(graph.start(h) + 1) + ' ' + std::to_string(graph.end[h] + 1) + '\n';
    return text;
}

PhaseFiles phase_files(const std::string& debug_dir, int depth) {
    const std::filesystem::path folder =
        std::filesystem::path(debug_dir) / std::string("d").append(std::to_string(depth));
    return {folder.string(), (folder / "voxels.obj").string(), (folder / "graph.obj").string(),
            (folder / "facets.off").string()};
}

void write_phases(const PhaseFiles& files, const Octree& octree, const OctreeLevel& level,
                  const ConnectivityGraph& graph, const PolygonMesh& facets, const CloudFrame& frame) {
    std::error_code error;
    std::filesystem::create_directories(files.folder, error);
    if (error) throw Error(files.folder, "cannot be made a folder (" + error.message() + "); choose another");
    write_mesh(files.voxels, voxel_cubes(octree, level, frame), MeshFormat::obj);
    write_text(files.graph, graph_obj(octree, graph, frame));
    PolygonMesh placed = facets;
    for (Vec3& p : placed.positions) p = frame.to_cloud(p);
    write_mesh(files.facets, placed, MeshFormat::off);
}

} // namespace hsdm
