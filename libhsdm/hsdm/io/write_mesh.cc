#include "hsdm/io/write_mesh.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/mesh_writers.hh"

#include <cctype>
#include <filesystem>

namespace hsdm {
namespace {

/// Checks what all writers below rely on.
void check(const std::string& path, const PolygonMesh& mesh) {
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

} // namespace

MeshFormat mesh_format(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".off") return MeshFormat::off;
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".om") return MeshFormat::om;
    throw Error(path,
                "no mesh format has the extension '" + extension + "'; use .off, .stl, .ply, .obj or .om");
}

WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                       const WriteOptions& options) {
    check(path, mesh);
    WrittenMesh written;
    if (format == MeshFormat::om) {
        write_polygons_om(path, mesh);
        return written;
    }
    AtomicFile file(path);
    switch (format) {
    case MeshFormat::off:
        write_off(file, mesh);
        break;
    case MeshFormat::stl:
        written.text_for_precision = write_stl(file, mesh, options.ascii) && !options.ascii;
        break;
    case MeshFormat::ply:
        write_ply(file, mesh, options.ascii);
        break;
    case MeshFormat::obj:
        write_obj(file, mesh);
        break;
    case MeshFormat::om:
        break; // done above
    }
    file.commit();
    return written;
}

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace hsdm
