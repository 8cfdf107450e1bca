#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"

namespace hsdm {
namespace {

void append_positions(std::string& out, const PolygonMesh& mesh, const VertexRows&, std::size_t begin,
                      std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
        for (unsigned k = 0; k < 3; ++k) {
            append_number(out, mesh.positions[v][k]);
            out += k < 2 ? ' ' : '\n';
        }
}

} // namespace

MeshDocument off_document(const MeshCounts& counts) {
    MeshDocument document;
    document.head = "OFF\n" + std::to_string(counts.vertices) + " " + std::to_string(counts.facets) + " 0\n";
    document.vertices.push_back({append_positions, false});
    document.facets = [](std::string& out, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) append_polygon(out, mesh.facet(f));
    };
    return document;
}

} // namespace hsdm
