#include "hsdm/io/read_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/mesh_readers.hh"

#include <cmath>

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

PolygonMesh read_by_content(const SourceBytes& bytes) {
    const Text text(bytes);
    const std::string_view view(text.begin, static_cast<std::size_t>(text.end - text.begin));
    const std::string& name = bytes.name();
    const std::string extension = lower(name.substr(std::min(name.find_last_of('.'), name.size())));
    if (view.starts_with("ply")) return read_mesh_ply(bytes);
    if (is_binary_stl(bytes) || is_text_stl(bytes) || extension == ".stl") return read_mesh_stl(bytes);
    const char* at = text.begin;
    if (extension == ".off" || is_off_keyword(trim(text.line(at)))) return read_mesh_off(bytes);
    if (extension == ".obj") return read_mesh_obj(bytes);
    if (extension == ".ply")
        text.fail(text.begin, "a PLY file begins with \"ply\"; this one does not, check it");
    throw Error(name, "no mesh format that is known; use OFF, STL, PLY or OBJ");
}

} // namespace
} // namespace io

PolygonMesh read_mesh(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    if (bytes.size() == 0) throw Error(bytes.name(), "is empty; expected a mesh");
    PolygonMesh mesh = io::read_by_content(bytes);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        for (double x : mesh.positions[v])
            if (!std::isfinite(x))
                throw Error(bytes.name(), "vertex " + std::to_string(v)
                                              + " has a coordinate that is not finite; remove or correct it");
    return mesh;
}

} // namespace hsdm
