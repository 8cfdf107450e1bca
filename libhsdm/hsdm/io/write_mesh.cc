#include "hsdm/io/write_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/text.hh"

#include <algorithm>
#include <array>
#include <filesystem>

namespace hsdm {

void check_consistent(const std::string& path, const PolygonMesh& mesh) {
    const std::size_t n = mesh.vertex_count();
    for (Index v : mesh.corners)
        if (v >= n)
            throw Error(path, "cannot write: a facet refers to vertex " + std::to_string(v)
                                  + ", but there are " + std::to_string(n) + "; the mesh is inconsistent");
    if (!mesh.normals.empty() && mesh.normals.size() != n)
        throw Error(path, "cannot write: " + std::to_string(mesh.normals.size()) + " normals for "
                              + std::to_string(n) + " vertices; the mesh is inconsistent");
    for (const VertexProperty& property : mesh.properties)
        if (property.values.size() != n)
            throw Error(path, "cannot write: " + std::to_string(property.values.size()) + " values of '"
                                  + property.name + "' for " + std::to_string(n)
                                  + " vertices; the mesh is inconsistent");
}

namespace {

/// Of formats that have no empty mesh.
void check_facets(const std::string& path, const PolygonMesh& mesh, const MeshFormatInfo& info) {
    if (info.format != MeshFormat::glb && info.format != MeshFormat::mf3) return;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (mesh.facet(f).size() >= 3) return;
    throw Error(path, "cannot write: no facets, which " + std::string(info.title) + " wants; write PLY");
}

} // namespace

std::span<const MeshFormatInfo> mesh_formats() {
    static constexpr std::array<MeshFormatInfo, 7> all{{
        {"off", MeshFormat::off, "OFF", false, false, true},
        {"stl", MeshFormat::stl, "STL", false, false, true},
        {"ply", MeshFormat::ply, "PLY", true, false, true},
        {"obj", MeshFormat::obj, "OBJ", true, false, true},
        {"om", MeshFormat::om, ".om", true, false, true},
        {"glb", MeshFormat::glb, "GLB", true, true, false},
        {"3mf", MeshFormat::mf3, "3MF", false, true, false},
    }};
    return all;
}

const MeshFormatInfo& info_of(MeshFormat format) {
    return *std::ranges::find(mesh_formats(), format, &MeshFormatInfo::format);
}

std::string_view name_of(LengthUnit unit) {
    constexpr std::array<std::string_view, 5> names{"", "mm", "cm", "m", "in"};
    return names[static_cast<std::size_t>(unit)];
}

double metres_of(LengthUnit unit) {
    constexpr std::array metres{1.0, 0.001, 0.01, 1.0, 0.0254};
    return metres[static_cast<std::size_t>(unit)];
}

MeshFormat mesh_format(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    const std::string name = io::lower(extension.substr(std::min<std::size_t>(extension.size(), 1)));
    std::string known;
    for (const MeshFormatInfo& info : mesh_formats()) {
        if (name == info.name) return info.format;
        known += known.empty() ? "" : info.format == mesh_formats().back().format ? " or " : ", ";
        known.append(".").append(info.name);
    }
    throw Error(path, "no mesh format has the extension '" + extension + "'; use " + known);
}

WrittenMesh precision_of(std::span<const Vec3> positions, const Vec3& shift, MeshFormat format, bool ascii) {
    WrittenMesh written;
    written.shift = shift;
    if (format != MeshFormat::stl) return written;
    written.moved_by_floats = moved_by_floats(positions, shift);
    written.text_for_precision = !ascii && written.moved_by_floats > most_moved_by_floats;
    return written;
}

void check_as_it_comes(const std::string& path, MeshFormat format) {
    if (!is_document(format))
        throw Error(path, std::string(info_of(format).title)
                              + " cannot be written as it comes; PLY, OFF and STL can");
}

namespace {

WrittenMesh write_as_it_is(const std::string& path, const PolygonMesh& mesh, const VertexRows& rows,
                           MeshFormat format, const WriteOptions& options) {
    const WrittenMesh written = precision_of(mesh.positions, {0, 0, 0}, format, options.ascii);
    if (format == MeshFormat::om) {
        write_polygons_om(path, mesh);
        return written;
    }
    AtomicFile file(path);
    switch (format) {
    case MeshFormat::off:
    case MeshFormat::stl:
    case MeshFormat::ply: {
        const bool ascii = options.ascii || written.text_for_precision;
        write_document(file, document_of(format, counts_of(mesh), rows, ascii), mesh, rows);
        break;
    }
    case MeshFormat::obj:
        write_obj(file, mesh);
        break;
    case MeshFormat::glb:
        write_glb(file, path, mesh, options.unit);
        break;
    case MeshFormat::mf3:
        write_3mf(file, path, mesh, options.unit);
        break;
    case MeshFormat::om:
        break; // done above
    }
    file.commit();
    return written;
}

WrittenMesh write_checked(const std::string& path, const PolygonMesh& mesh, const VertexRows& rows,
                          MeshFormat format, const WriteOptions& options) {
    check_consistent(path, mesh);
    check_facets(path, mesh, info_of(format));
    if (!options.recentre) return write_as_it_is(path, mesh, rows, format, options);
    PolygonMesh near = mesh;
    const Vec3 shift = recentring_shift(mesh.positions);
    for (Vec3& p : near.positions) p -= shift;
    WrittenMesh written = write_as_it_is(path, near, rows, format, options);
    written.shift = shift;
    return written;
}

} // namespace

WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                       const WriteOptions& options) {
    return write_checked(path, mesh, rows_of(mesh), format, options);
}

WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, const VertexRows& rows,
                       MeshFormat format, const WriteOptions& options) {
    check_as_it_comes(path, format);
    return write_checked(path, mesh, rows, format, options);
}

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace hsdm
