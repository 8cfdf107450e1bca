#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_writers.hh"

#include <algorithm>

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

std::size_t largest_facet(const PolygonMesh& mesh) {
    std::size_t largest = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) largest = std::max(largest, mesh.facet(f).size());
    return largest;
}

std::string header(const PolygonMesh& mesh, bool ascii) {
    std::string h = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") + " 1.0\n";
    h += "comment hsdm\nelement vertex " + std::to_string(mesh.vertex_count()) + "\n";
    for (const char* name : {"x", "y", "z"}) h += std::string("property double ") + name + "\n";
    if (!mesh.normals.empty())
        for (const char* name : {"nx", "ny", "nz"}) h += std::string("property double ") + name + "\n";
    for (const VertexProperty& p : mesh.properties)
        h += std::string("property ") + type_name(p.type) + " " + p.name + "\n";
    h += "element face " + std::to_string(mesh.facet_count()) + "\nproperty list ";
    return h + (largest_facet(mesh) < 256 ? "uchar" : "uint") + " uint vertex_indices\nend_header\n";
}

/// Calls put(value) with the value in the property's own type.
template <class Put>
void with_type(const VertexProperty& property, std::size_t v, Put put) {
    const double value = property.values[v];
    switch (property.type) {
    case Type::uint8:
        return put(static_cast<std::uint8_t>(value));
    case Type::int32:
        return put(static_cast<std::int32_t>(value));
    case Type::float32:
        return put(static_cast<float>(value));
    case Type::float64:
        return put(value);
    }
}

void write_ascii(AtomicFile& file, const PolygonMesh& mesh) {
    write_chunks(file, mesh.vertex_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        auto put = [&](auto value) {
            append_number(out, value);
            out += ' ';
        };
        for (std::size_t v = begin; v < end; ++v) {
            for (double x : mesh.positions[v]) put(x);
            if (!mesh.normals.empty())
                for (double x : mesh.normals[v]) put(x);
            for (const VertexProperty& p : mesh.properties) with_type(p, v, put);
            out.back() = '\n';
        }
    });
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            append_number(out, mesh.facet(f).size());
            for (Index v : mesh.facet(f)) append_number(out += ' ', v);
            out += '\n';
        }
    });
}

void write_binary(AtomicFile& file, const PolygonMesh& mesh) {
    write_chunks(file, mesh.vertex_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        auto put = [&](auto value) { append_bytes(out, value); };
        for (std::size_t v = begin; v < end; ++v) {
            for (double x : mesh.positions[v]) put(x);
            if (!mesh.normals.empty())
                for (double x : mesh.normals[v]) put(x);
            for (const VertexProperty& p : mesh.properties) with_type(p, v, put);
        }
    });
    const bool short_count = largest_facet(mesh) < 256;
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto corners = static_cast<std::uint32_t>(mesh.facet(f).size());
            if (short_count)
                append_bytes(out, static_cast<std::uint8_t>(corners));
            else
                append_bytes(out, corners);
            for (Index v : mesh.facet(f)) append_bytes(out, v);
        }
    });
}

} // namespace

void write_ply(AtomicFile& file, const PolygonMesh& mesh, bool ascii) {
    file.write(header(mesh, ascii));
    if (ascii)
        write_ascii(file, mesh);
    else
        write_binary(file, mesh);
}

} // namespace hsdm
