#include "hsdm/io/write_om.hh"

#include "hsdm/errors.hh"
#include "hsdm/facets/to_mesh.hh"
#include "hsdm/features/vertex_normals.hh"
#include "hsdm/io/mesh_writers.hh"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <sstream>

namespace hsdm {
namespace {

/// OpenMesh's writer reports bytes to its log, which is standard error unless the user says otherwise; a
/// library call prints nothing.
class QuietLog {
public:
    QuietLog() : was_enabled_(omlog().is_enabled()) { omlog().disable(); }
    ~QuietLog() {
        if (was_enabled_) omlog().enable();
    }
    QuietLog(const QuietLog&) = delete;
    QuietLog& operator=(const QuietLog&) = delete;

private:
    bool was_enabled_;
};

} // namespace

void write_om(const std::string& path, const PolyMesh& mesh) {
    using OpenMesh::IO::Options;
    Options options(Options::Binary);
    options += Options::VertexNormal;
    options += Options::Status;
    options += Options::Custom;
    const QuietLog quiet;
    std::ostringstream content;
    if (!OpenMesh::IO::write_mesh(mesh, content, ".om", options))
        throw Error(path, "OpenMesh could not write this mesh as .om; write OFF or PLY instead");
    AtomicFile file(path);
    file.write(std::move(content).str());
    file.commit();
}

void write_polygons_om(const std::string& path, const PolygonMesh& mesh) {
    const ToMeshResult result = to_mesh(mesh);
    if (result.rejected > 0)
        throw Error(path,
                    std::to_string(result.rejected)
                        + " facets meet where a half-edge mesh cannot hold them; write OFF or PLY instead");
    write_om(path, result.mesh);
}

} // namespace hsdm
