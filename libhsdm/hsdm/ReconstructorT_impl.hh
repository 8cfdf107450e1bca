#pragma once

#include "hsdm/features/VertexFanT.hh"
#include "hsdm/mesh/triangle_mesh.hh"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace hsdm {
namespace detail {

/// The elements of both meshes have the same numbers, so half-edges are copied as they are.
template <class Mesh>
void copy_connectivity(const PolyMesh& from, Mesh& to) {
    to.clear();
    to.resize(from.n_vertices(), from.n_edges(), from.n_faces());
    for (const auto h : from.halfedges()) {
        to.set_vertex_handle(h, from.to_vertex_handle(h));
        to.set_next_halfedge_handle(h, from.next_halfedge_handle(h));
        to.set_face_handle(h, from.face_handle(h));
    }
    for (const auto v : from.vertices()) to.set_halfedge_handle(v, from.halfedge_handle(v));
    for (const auto f : from.faces()) to.set_halfedge_handle(f, from.halfedge_handle(f));
}

template <class Mesh>
void copy_attributes(const PolyMesh& from, Mesh& to) {
    for (const auto v : from.vertices()) {
        to.set_point(v, to_normal<typename Mesh::Point>(from.point(v)));
        if (to.has_vertex_normals()) to.set_normal(v, to_normal<typename Mesh::Normal>(from.normal(v)));
        if (to.has_vertex_status()) to.status(v) = from.status(v);
    }
    for (const auto f : from.faces()) {
        if (to.has_face_normals()) to.set_normal(f, to_normal<typename Mesh::Normal>(from.normal(f)));
        if (to.has_face_status()) to.status(f) = from.status(f);
    }
    if (!to.has_edge_status()) return;
    for (const auto e : from.edges()) to.status(e) = from.status(e);
}

/// Copies the property if its values are of this type.
template <class T, class Mesh>
void copy_property(const OpenMesh::BaseProperty& base, Mesh& to) {
    const auto* from = dynamic_cast<const OpenMesh::PropertyT<T>*>(&base);
    if (from == nullptr) return;
    auto property = kept_vertex_property<T>(to, base.name().c_str());
    to.property(property.getRawProperty()).data_vector() = from->data_vector();
}

template <class Mesh>
void copy_properties(const PolyMesh& from, Mesh& to) {
    for (auto it = from.vprops_begin(); it != from.vprops_end(); ++it) {
        if (*it == nullptr || (*it)->name().substr(1, 1) == ":") continue;
        copy_property<std::uint8_t>(**it, to);
        copy_property<std::int32_t>(**it, to);
        copy_property<float>(**it, to);
        copy_property<double>(**it, to);
        const auto* normals = dynamic_cast<const OpenMesh::PropertyT<VertexNormalsT<PolyMesh>>*>(*it);
        if (normals == nullptr) continue;
        auto copies = kept_vertex_property<VertexNormalsT<Mesh>>(to, (*it)->name().c_str());
        for (const auto v : from.vertices())
            for (std::size_t k = 0; k < 3; ++k)
                copies[v][k] = to_normal<typename Mesh::Normal>(normals->data_vector()[index_of(v)][k]);
    }
}

} // namespace detail

template <class Mesh>
void copy_mesh(const PolyMesh& from, Mesh& to) {
    detail::copy_connectivity(from, to);
    detail::copy_attributes(from, to);
    detail::copy_properties(from, to);
}

template <class Mesh>
void ReconstructorT<Mesh>::initialize(const ReconstructOptions& options) {
    options_ = options;
    is_initialized_ = true;
}

template <class Mesh>
PointCloud ReconstructorT<Mesh>::read_cloud() const {
    PointCloud cloud;
    cloud.positions.reserve(mesh_.n_vertices());
    for (const auto v : mesh_.vertices()) cloud.positions.push_back(to_vec3(mesh_.point(v)));
    if (!mesh_.has_vertex_normals()) return cloud;
    for (const auto v : mesh_.vertices()) cloud.normals.push_back(to_vec3(mesh_.normal(v)));
    const bool given = std::any_of(cloud.normals.begin(), cloud.normals.end(),
                                   [](const Vec3& normal) { return normal.sqrnorm() > 0; });
    if (!given) cloud.normals.clear();
    return cloud;
}

template <class Mesh>
Report ReconstructorT<Mesh>::reconstruct() {
    if (!is_initialized_) throw std::logic_error("ReconstructorT: reconstruct() called before initialize()");
    Reconstruction result = hsdm::reconstruct(read_cloud(), options_);
    result.mesh.garbage_collection();
    if constexpr (Mesh::is_trimesh())
        copy_mesh(triangle_mesh(result.mesh), mesh_);
    else
        copy_mesh(result.mesh, mesh_);
    return std::move(result.report);
}

} // namespace hsdm
