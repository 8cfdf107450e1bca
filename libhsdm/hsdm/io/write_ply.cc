#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_writers.hh"

namespace hsdm {
namespace {

using Type = VertexProperty::Type;

const char* type_name(Type type) {
    switch (type) {
    case Type::uint8:
        return "uchar";
    case Type::int32:
        return "int";
    case Type::float32:
        return "float";
    case Type::float64:
        return "double";
    }
    return "";
}

bool has_short_counts(const MeshCounts& counts) {
    return counts.largest_facet < 256;
}

std::string header(const MeshCounts& counts, const VertexRows& rows, bool ascii) {
    std::string h = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") + " 1.0\n";
    h += "comment hsdm\nelement vertex " + std::to_string(counts.vertices) + "\n";
    for (const char* name : {"x", "y", "z"}) h += std::string("property double ") + name + "\n";
    if (rows.normals)
        for (const char* name : {"nx", "ny", "nz"}) h += std::string("property double ") + name + "\n";
    for (const auto& [name, type] : rows.columns)
        h += std::string("property ") + type_name(type) + " " + name + "\n";
    h += "element face " + std::to_string(counts.facets) + "\nproperty list ";
    return h + (has_short_counts(counts) ? "uchar" : "uint") + " uint vertex_indices\nend_header\n";
}

/// Calls put(number) for all numbers of vertices begin .. end - 1, and end_row() after each vertex.
template <class Put, class EndRow>
void put_vertices(const PolygonMesh& mesh, const VertexRows& rows, std::size_t begin, std::size_t end,
                  const Put& put, const EndRow& end_row) {
    std::vector<Vec3> normals;
    std::vector<double> values;
    if (rows.fill) rows.fill(begin, end, normals, values);
    for (std::size_t v = begin; v < end; ++v) {
        for (double x : mesh.positions[v]) put(x);
        if (rows.normals)
            for (double x : normals[v - begin]) put(x);
        for (std::size_t k = 0; k < rows.columns.size(); ++k)
            with_type(rows.columns[k].second, values[(v - begin) * rows.columns.size() + k], put);
        end_row();
    }
}

void describe_ascii(MeshDocument& document) {
    document.vertices.push_back({[](std::string& out, const PolygonMesh& mesh, const VertexRows& rows,
                                    std::size_t begin, std::size_t end) {
        const auto put = [&](auto value) {
            append_number(out, value);
            out += ' ';
        };
        put_vertices(mesh, rows, begin, end, put, [&] { out.back() = '\n'; });
    }});
    document.facets = [](std::string& out, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) append_polygon(out, mesh.facet(f));
    };
}

void describe_binary(MeshDocument& document, bool short_counts) {
    document.vertices.push_back({[](std::string& out, const PolygonMesh& mesh, const VertexRows& rows,
                                    std::size_t begin, std::size_t end) {
        put_vertices(
            mesh, rows, begin, end, [&](auto value) { append_bytes(out, value); }, [] {});
    }});
    document.facets = [short_counts](std::string& out, const PolygonMesh& mesh, std::size_t begin,
                                     std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto corners = static_cast<std::uint32_t>(mesh.facet(f).size());
            if (short_counts)
                append_bytes(out, static_cast<std::uint8_t>(corners));
            else
                append_bytes(out, corners);
            for (Index v : mesh.facet(f)) append_bytes(out, v);
        }
    };
}

} // namespace

VertexRows rows_of(const PolygonMesh& mesh) {
    VertexRows rows;
    rows.normals = !mesh.normals.empty();
    for (const VertexProperty& property : mesh.properties)
        rows.columns.emplace_back(property.name, property.type);
    rows.fill = [&mesh](std::size_t begin, std::size_t end, std::vector<Vec3>& normals,
                        std::vector<double>& values) {
        const auto at = [&](std::size_t v) { return mesh.normals.begin() + static_cast<std::ptrdiff_t>(v); };
        if (!mesh.normals.empty()) normals.assign(at(begin), at(end));
        for (std::size_t v = begin; v < end; ++v)
            for (const VertexProperty& property : mesh.properties) values.push_back(property.values[v]);
    };
    return rows;
}

MeshDocument ply_document(const MeshCounts& counts, const VertexRows& rows, bool ascii) {
    MeshDocument document;
    document.head = header(counts, rows, ascii);
    if (ascii)
        describe_ascii(document);
    else
        describe_binary(document, has_short_counts(counts));
    return document;
}

} // namespace hsdm
