#include "hsdm/io/linked_mesh.hh"

#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_writers.hh"

#include <algorithm>

namespace hsdm {

WrittenMesh write_mesh(const std::string& path, const LinkedMesh& mesh, MeshFormat format,
                       const WriteOptions& options) {
    return write_checked(path, mesh.facets, format, options, [&](const PolygonMesh& facets, bool ascii) {
        const LinkedMesh near{facets, mesh.links, mesh.sharp, mesh.rows};
        if (format == MeshFormat::om) return write_om(path, near);
        AtomicFile file(path);
        if (format == MeshFormat::glb)
            write_glb(file, path, near, options.unit);
        else if (format == MeshFormat::mf3)
            write_3mf(file, path, facets,
                      std::ranges::find(mesh.links.twin, no_index) == mesh.links.twin.end(), options.unit);
        else
            write_document(file, format, facets, mesh.rows, ascii);
        file.commit();
    });
}

} // namespace hsdm
