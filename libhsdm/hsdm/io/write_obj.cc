#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"

namespace hsdm {
namespace {

void append_vector(std::string& out, const char* keyword, const Vec3& vector) {
    out += keyword;
    for (const double x : vector) append_number(out += ' ', x);
    out += '\n';
}

void append_position_lines(std::string& out, const PolygonMesh& mesh, const VertexRows&, std::size_t begin,
                           std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) append_vector(out, "v", mesh.positions[v]);
}

void append_normal_lines(std::string& out, const PolygonMesh&, const VertexRows& rows, std::size_t begin,
                         std::size_t end) {
    std::vector<Vec3> normals;
    std::vector<double> values;
    rows.fill(begin, end, normals, values);
    for (const Vec3& normal : normals) append_vector(out, "vn", normal);
}

} // namespace

MeshDocument obj_document(bool normals) {
    MeshDocument document;
    document.vertices.push_back({append_position_lines, false});
    if (normals) document.vertices.push_back({append_normal_lines});
    document.facets = [normals](std::string& out, const PolygonMesh& mesh, std::size_t begin,
                                std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            out += 'f';
            for (const Index v : mesh.facet(f)) {
                append_number(out += ' ', v + 1u);
                if (normals) append_number(out += "//", v + 1u);
            }
            out += '\n';
        }
    };
    return document;
}

} // namespace hsdm
