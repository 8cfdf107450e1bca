#include "hsdm/io/formats.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/mesh/weld.hh"

namespace hsdm::io {

PolygonMesh read_mesh_stl(const SourceBytes& bytes) {
    const std::vector<Vec3> corners = read_stl_corners(bytes);
    const std::vector<Index> same = weld(corners);
    PolygonMesh mesh;
    std::vector<Index> vertex(corners.size());
    mesh.corners.reserve(corners.size());
    for (std::size_t c = 0; c < corners.size(); ++c) {
        if (same[c] == c) {
            vertex[c] = static_cast<Index>(mesh.positions.size());
            mesh.positions.push_back(corners[c]);
        }
        mesh.corners.push_back(vertex[same[c]]);
        if (c % 3 == 2) mesh.first.push_back(static_cast<Index>(c + 1));
    }
    return mesh;
}

} // namespace hsdm::io
