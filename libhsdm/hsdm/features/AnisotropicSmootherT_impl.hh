#pragma once

#include "hsdm/features/HalfEdgesT.hh"

#include <stdexcept>
#include <vector>

namespace hsdm {

template <class Mesh>
AnisotropicSmootherT<Mesh>::AnisotropicSmootherT(Mesh& mesh) : mesh_(mesh) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
}

template <class Mesh>
AnisotropicSmootherT<Mesh>::~AnisotropicSmootherT() {
    mesh_.release_face_status();
    mesh_.release_edge_status();
    mesh_.release_vertex_status();
}

template <class Mesh>
void AnisotropicSmootherT<Mesh>::initialize(const VertexSmoothingOptions& options) {
    validate(options);
    options_ = options;
    is_initialized_ = true;
}

template <class Mesh>
VertexSmoothingResult AnisotropicSmootherT<Mesh>::smooth() {
    if (!is_initialized_) throw std::logic_error("AnisotropicSmootherT: smooth() called before initialize()");
    HalfEdges flat = half_edges_of(mesh_);
    const std::vector<Vec3> before = flat.positions;
    const VertexSmoothingResult result = smooth_positions(flat, options_);
    for_each_handle<OpenMesh::VertexHandle>(before.size(), [&](OpenMesh::VertexHandle v) {
        const Vec3& place = flat.positions[index_of(v)];
        if (place != before[index_of(v)]) mesh_.set_point(v, to_normal<typename Mesh::Point>(place));
    });
    renew_normals(mesh_);
    return result;
}

} // namespace hsdm
