#include "hsdm/io/write_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/text.hh"
#include "hsdm/quality/topology.hh"

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

void check_facets(const std::string& path, const PolygonMesh& mesh, MeshFormat format) {
    if (format != MeshFormat::glb && format != MeshFormat::mf3) return;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (mesh.facet(f).size() >= 3) return;
    throw Error(path,
                "cannot write: no facets, which " + std::string(info_of(format).title) + " wants; write PLY");
}

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

WrittenMesh write_checked(const std::string& path, const PolygonMesh& facets, MeshFormat format,
                          const WriteOptions& options,
                          const std::function<void(const PolygonMesh& facets, bool ascii)>& write) {
    check_consistent(path, facets);
    check_facets(path, facets, format);
    PolygonMesh near;
    const Vec3 shift = options.recentre ? recentring_shift(facets.positions) : Vec3(0, 0, 0);
    if (shift != Vec3(0, 0, 0)) {
        near = facets;
        for (Vec3& p : near.positions) p -= shift;
    }
    const PolygonMesh& written_facets = near.positions.empty() ? facets : near;
    WrittenMesh written = precision_of(written_facets.positions, {0, 0, 0}, format, options.ascii);
    write(written_facets, options.ascii || written.text_for_precision);
    written.shift = shift;
    return written;
}

WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                       const WriteOptions& options) {
    return write_checked(path, mesh, format, options, [&](const PolygonMesh& facets, bool ascii) {
        if (format == MeshFormat::om) return write_polygons_om(path, facets);
        AtomicFile file(path);
        if (format == MeshFormat::glb)
            write_glb(file, path, facets, options.unit);
        else if (format == MeshFormat::mf3)
            write_3mf(file, path, facets, measure_topology(facets).closed(), options.unit);
        else
            write_document(file, format, facets, rows_of(facets), ascii);
        file.commit();
    });
}

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace hsdm
