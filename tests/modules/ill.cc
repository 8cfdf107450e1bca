// A module that does all the harm that its option `how` names.

#include "hsdm/plugin.hh"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <limits>

namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Recursion without end, which the compiler must not turn into a loop.
int fall(volatile int* depth) {
    volatile int here = *depth + 1;
    return here < 0 ? 0 : fall(&here) + here;
}

void break_links(hsdm::PolyMesh& mesh, const std::string& how) {
    const HalfedgeHandle h(0);
    if (how == "next") mesh.set_next_halfedge_handle(h, h);
    if (how == "far-vertex") mesh.set_vertex_handle(h, VertexHandle(-7));
    if (how == "far-face") mesh.set_face_handle(h, FaceHandle(1 << 30));
    if (how == "other-face") mesh.set_face_handle(h, FaceHandle(3));
    if (how == "no-side") mesh.set_halfedge_handle(FaceHandle(2), HalfedgeHandle());
    if (how == "other-side") mesh.set_halfedge_handle(VertexHandle(2), mesh.halfedge_handle(VertexHandle(3)));
    if (how == "half-deleted") mesh.status(FaceHandle(1)).set_deleted(true);
    if (how == "released") mesh.release_edge_status();
}

void hurt(hsdm::PolyMesh& mesh, const std::string& how) {
    break_links(mesh, how);
    if (how == "nan") mesh.set_point(VertexHandle(5), {0, not_a_number, 0});
    if (how == "nan-normal") mesh.set_normal(VertexHandle(5), {0, not_a_number, 0});
    if (how == "empty")
        for (const auto f : mesh.faces()) mesh.delete_face(f, false);
    if (how == "delete") mesh.delete_face(FaceHandle(0), false);
    if (how == "clear") mesh.clear();
    if (how == "abort") std::abort();
    if (how == "segv") std::raise(SIGSEGV);
    if (how == "exit") std::exit(0);
    int depth = 0;
    if (how == "overflow") fall(&depth);
    for (static std::atomic<int> turns; how == "loop"; ++turns) {
    }
}

std::string run(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
    hurt(mesh, options.text("how", ""));
    return "done";
}

} // namespace

HSDM_PLUGIN("ill", "does what no module may", "how= (text): what", run)
