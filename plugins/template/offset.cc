// A stage that moves vertices along their normals: hsdm process in.off -o out.off --stage offset:distance=0.5
#include <hsdm/errors.hh>
#include <hsdm/plugin.hh>

#include <string>

namespace {

/// Returns what `hsdm process` prints; hsdm has checked the options against their declarations below. What is
/// wrong beyond those is an OptionError (status 2); whatever else is thrown is a failure (status 1).
std::string offset(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
    const double distance = options.number("distance", 0);
    const bool keep_sharp = options.text("sharp", "move") == "keep";
    if (distance == 0) throw hsdm::OptionError("distance 0: nothing would move; give another");

    mesh.request_face_normals();
    mesh.update_face_normals();
    mesh.update_vertex_normals(); // of the faces round each vertex
    std::size_t moved = 0;
    for (const auto v : mesh.vertices()) {
        if (keep_sharp && v.feature()) continue; // the status bit of sharp edges' vertices and corners
        mesh.set_point(v, mesh.point(v) + distance * mesh.normal(v));
        ++moved;
    }
    mesh.release_face_normals();
    return "moved " + std::to_string(moved) + " vertices by " + options.text("distance", "0");
}

} // namespace

HSDM_PLUGIN("offset", "moves vertices along their normals",
            "distance= (number): in the mesh's units, inwards below 0; "
            "sharp=move (move|keep): what becomes of vertices on sharp edges",
            offset)
