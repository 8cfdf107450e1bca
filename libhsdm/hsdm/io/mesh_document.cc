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
    return format == MeshFormat::ply || format == MeshFormat::off || format == MeshFormat::stl
           || format == MeshFormat::obj;
}

VertexRows rows_held(MeshFormat format, const VertexRows& rows) {
    VertexRows held;
    if (format == MeshFormat::ply) held = rows;
    if (format == MeshFormat::obj) held.normals = rows.normals, held.fill = rows.fill;
    return held;
}

MeshDocument document_of(MeshFormat format, const MeshCounts& counts, const VertexRows& rows, bool ascii) {
    if (format == MeshFormat::off) return off_document(counts);
    if (format == MeshFormat::stl) return stl_document(counts, ascii);
    if (format == MeshFormat::obj) return obj_document(rows.normals);
    return ply_document(counts, rows, ascii);
}

void write_document(AtomicFile& file, MeshFormat format, const PolygonMesh& mesh, const VertexRows& rows,
                    bool ascii) {
    const VertexRows held = rows_held(format, rows);
    const MeshDocument document = document_of(format, counts_of(mesh), held, ascii);
    file.write(document.head);
    for (const MeshDocument::OfVertices& row : document.vertices)
        write_chunks(file, mesh.vertex_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
            row.append(out, mesh, held, begin, end);
        });
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        document.facets(out, mesh, begin, end);
    });
    file.write(document.tail);
}

} // namespace hsdm
