#include "hsdm/io/mesh_document.hh"

#include "hsdm/io/format_chunks.hh"

#include <algorithm>

namespace hsdm {

MeshCounts counts_of(const PolygonMesh& mesh) {
    MeshCounts counts{mesh.vertex_count(), mesh.facet_count()};
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const std::size_t corners = mesh.facet(f).size();
        counts.largest_facet = std::max(counts.largest_facet, corners);
        counts.triangles += corners < 3 ? 0 : corners - 2;
    }
    return counts;
}

bool is_document(MeshFormat format) {
    return format == MeshFormat::ply || format == MeshFormat::off || format == MeshFormat::stl;
}

MeshDocument document_of(MeshFormat format, const MeshCounts& counts, const VertexRows& rows, bool ascii) {
    if (format == MeshFormat::off) return off_document(counts);
    if (format == MeshFormat::stl) return stl_document(counts, ascii);
    return ply_document(counts, rows, ascii);
}

void write_document(AtomicFile& file, const MeshDocument& document, const PolygonMesh& mesh,
                    const VertexRows& rows) {
    file.write(document.head);
    if (document.vertices)
        write_chunks(file, mesh.vertex_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
            document.vertices(out, mesh, rows, begin, end);
        });
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        document.facets(out, mesh, begin, end);
    });
    file.write(document.tail);
}

} // namespace hsdm
