#include "hsdm/mesh/check_links.hh"

#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/types.hh"

#include <vector>

namespace hsdm {
namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

template <class Handle>
std::size_t index_of(Handle handle) {
    return static_cast<std::size_t>(handle.idx());
}

template <class Handle>
std::string numbered(const char* name, Handle handle) {
    return std::string(name) + " " + std::to_string(handle.idx());
}

class LinkCheck {
public:
    explicit LinkCheck(const PolyMesh& mesh)
        : mesh_(mesh), sides_out_(mesh.n_vertices()), sides_(mesh.n_faces()) {}

    std::string run() {
        if (!mesh_.has_vertex_status() || !mesh_.has_edge_status() || !mesh_.has_face_status()
            || !mesh_.has_vertex_normals() || !mesh_.has_face_normals())
            return "a mesh without its normals or status bits, which it has released once too often";
        // In this order: what a later one follows an earlier one has checked.
        if (const std::string fault = of_half_edges(); !fault.empty()) return fault;
        if (const std::string fault = of_faces(); !fault.empty()) return fault;
        return of_vertices();
    }

private:
    bool lives(VertexHandle v) const { return mesh_.is_valid_handle(v) && !mesh_.status(v).deleted(); }
    bool lives(FaceHandle f) const { return mesh_.is_valid_handle(f) && !mesh_.status(f).deleted(); }
    bool lives(HalfedgeHandle h) const {
        return mesh_.is_valid_handle(h) && !mesh_.status(mesh_.edge_handle(h)).deleted();
    }

    /// Each half-edge is the next one's previous one. So no two have the same next one, and whoever goes from
    /// one to the next comes back to where they began.
    std::string of_half_edges() {
        for (std::size_t i = 0; i < mesh_.n_halfedges(); ++i) {
            const HalfedgeHandle h(static_cast<int>(i));
            if (!lives(h)) continue;
            const HalfedgeHandle next = mesh_.next_halfedge_handle(h);
            const VertexHandle from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
            const FaceHandle f = mesh_.face_handle(h);
            if (!lives(to) || !lives(from) || to == from)
                return numbered("half-edge", h) + " without two vertices that are there";
            if (!lives(next) || mesh_.prev_halfedge_handle(next) != h || mesh_.from_vertex_handle(next) != to
                || mesh_.face_handle(next) != f)
                return numbered("half-edge", h) + " in no closed loop";
            if (f.idx() != -1 && !lives(f)) return numbered("half-edge", h) + " of a face that is not there";
            ++sides_out_[index_of(from)];
            if (f.idx() != -1) ++sides_[index_of(f)];
        }
        return "";
    }

    std::string of_faces() const {
        for (std::size_t i = 0; i < mesh_.n_faces(); ++i) {
            const FaceHandle f(static_cast<int>(i));
            if (!lives(f)) continue;
            const HalfedgeHandle first = mesh_.halfedge_handle(f);
            if (!lives(first) || mesh_.face_handle(first) != f)
                return numbered("face", f) + " without a half-edge of its own";
            Index length = 0;
            HalfedgeHandle h = first;
            do {
                h = mesh_.next_halfedge_handle(h);
                ++length;
            } while (h != first);
            if (length < 3 || length != sides_[i])
                return numbered("face", f) + " of " + std::to_string(length) + " sides in one loop and "
                       + std::to_string(sides_[i]) + " in all";
        }
        return "";
    }

    std::string of_vertices() const {
        for (std::size_t i = 0; i < mesh_.n_vertices(); ++i) {
            const VertexHandle v(static_cast<int>(i));
            if (!lives(v)) continue;
            if (!is_finite(mesh_.point(v))) return numbered("vertex", v) + " at no finite position";
            const HalfedgeHandle first = mesh_.halfedge_handle(v);
            if (first.idx() == -1 && sides_out_[i] == 0) continue; // isolated
            if (!lives(first) || mesh_.from_vertex_handle(first) != v)
                return numbered("vertex", v) + " without a half-edge of its own";
            Index length = 0;
            bool has_boundary = false;
            HalfedgeHandle h = first;
            do {
                has_boundary = has_boundary || mesh_.is_boundary(h);
                h = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(h));
                ++length;
            } while (h != first);
            if (length != sides_out_[i]) return numbered("vertex", v) + " with faces in more than one fan";
            if (has_boundary && !mesh_.is_boundary(first))
                return numbered("vertex", v) + " on the boundary whose half-edge is not (see "
                       + "adjust_outgoing_halfedge)";
        }
        return "";
    }

    const PolyMesh& mesh_;
    std::vector<Index> sides_out_; ///< half-edges that begin at each vertex
    std::vector<Index> sides_;     ///< half-edges of each face
};

} // namespace

std::string fault_of(const PolyMesh& mesh) {
    return LinkCheck(mesh).run();
}

void drop_nonfinite_normals(PolyMesh& mesh) {
    OpenMesh::VPropHandleT<VertexNormalsT<PolyMesh>> property;
    const bool has_normals = mesh.get_property_handle(property, vertex_normals_property);
    for (const auto v : mesh.vertices()) {
        if (!is_finite(mesh.normal(v))) mesh.set_normal(v, Vec3(0, 0, 0));
        if (!has_normals) continue;
        for (Vec3& normal : mesh.property(property, v))
            if (!is_finite(normal)) normal = Vec3(0, 0, 0);
    }
}

} // namespace hsdm
