#include "hsdm/io/read_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/io/write_mesh.hh"

namespace hsdm {
namespace io {

void check_corners(const Text& text, const PolygonMesh& mesh, const std::vector<const char*>& facet_at) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index v : mesh.facet(f)) {
            if (v < mesh.vertex_count()) continue;
            const std::string what =
                "face " + std::to_string(f) + " refers to a vertex that is not there: there are "
                + std::to_string(mesh.vertex_count()) + "; correct the face, or the vertices";
            if (f < facet_at.size()) text.fail(facet_at[f], what);
            throw Error(text.file(), what);
        }
}

namespace {

PolygonMesh read_as(const SourceBytes& bytes, std::string_view format) {
    if (format == "ply") return read_mesh_ply(bytes);
    if (format == "stl") return read_mesh_stl(bytes);
    if (format == "om") return read_mesh_om(bytes);
    return format == "off" ? read_mesh_off(bytes) : read_mesh_obj(bytes);
}

/// "OFF, STL, PLY, OBJ or .om"
std::string titles_of_read_formats() {
    std::vector<std::string_view> titles;
    for (const MeshFormatInfo& info : mesh_formats())
        if (info.is_read) titles.push_back(info.title);
    std::string text;
    for (std::size_t i = 0; i < titles.size(); ++i)
        text.append(i == 0 ? "" : i + 1 == titles.size() ? " or " : ", ").append(titles[i]);
    return text;
}

} // namespace

/// Chooses the reader by the content, else by the name; then the file must be what its name says.
PolygonMesh read_mesh(const SourceBytes& bytes) {
    if (bytes.size() == 0) throw Error(bytes.name(), "is empty; expected a mesh");
    std::string_view format = mesh_format_of(bytes);
    const std::string extension =
        lower(bytes.name().substr(std::min(bytes.name().find_last_of('.'), bytes.name().size())));
    for (const std::string_view known : {"off", "stl", "obj"})
        if (format.empty() && extension == std::string(".").append(known)) format = known;
    if (format.empty() && extension == ".ply")
        throw Error(bytes.name(), 1, "a PLY file begins with \"ply\"; this one does not, check it");
    if (format.empty())
        throw Error(bytes.name(), "no mesh format that is known; use " + titles_of_read_formats());
    PolygonMesh mesh = read_as(bytes, format);
    if (mesh.facet_count() == 0) return mesh;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        if (!is_finite(mesh.positions[v]))
            throw Error(bytes.name(), "vertex " + std::to_string(v)
                                          + " has a coordinate that is not finite; remove or correct it");
    return mesh;
}

} // namespace io

PolygonMesh read_mesh(const std::string& path) {
    return io::read_mesh(io::SourceBytes::open(path));
}

MeshOrPoints read_mesh_or_points(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    MeshOrPoints found;
    if (!io::mesh_format_of(bytes).empty()) found.mesh = io::read_mesh(bytes);
    if (found.mesh.facet_count() > 0) return found;
    found.mesh = {};
    found.points = io::read_points(bytes, {});
    return found;
}

} // namespace hsdm
