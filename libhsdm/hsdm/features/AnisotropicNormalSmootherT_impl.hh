#pragma once

#include "hsdm/errors.hh"
#include "hsdm/features/VertexFanT.hh"

#include <stdexcept>
#include <string>

namespace hsdm {

template <class Mesh>
AnisotropicNormalSmootherT<Mesh>::AnisotropicNormalSmootherT(Mesh& mesh) : mesh_(mesh) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
    mesh_.request_vertex_normals();
}

template <class Mesh>
AnisotropicNormalSmootherT<Mesh>::~AnisotropicNormalSmootherT() {
    mesh_.release_vertex_normals();
    mesh_.release_face_status();
    mesh_.release_edge_status();
    mesh_.release_vertex_status();
}

template <class Mesh>
void AnisotropicNormalSmootherT<Mesh>::initialize(const NormalSmoothingOptions& options) {
    validate(options);
    options_ = options;
    read_facets();
    neighbours_ = facet_neighbours(mesh_, StatusBits::obey);
    is_initialized_ = true;
}

template <class Mesh>
void AnisotropicNormalSmootherT<Mesh>::read_facets() {
    normals_ = facet_area_vectors(mesh_);
    resize_large(area_, normals_.size());
    for_each_handle<OpenMesh::FaceHandle>(normals_.size(), [&](OpenMesh::FaceHandle f) {
        Vec3& normal = normals_[index_of(f)];
        area_[index_of(f)] = 0.5 * normal.norm();
        normal = unit_or_zero(normal);
    });
}

template <class Mesh>
std::size_t AnisotropicNormalSmootherT<Mesh>::smooth(int rounds) {
    if (!is_initialized_)
        throw std::logic_error("AnisotropicNormalSmootherT: smooth() called before initialize()");
    if (rounds < 0) throw OptionError("rounds " + std::to_string(rounds) + ": must not be negative");
    std::size_t turning = 0;
    for (int round = 0; round < rounds; ++round)
        turning =
            filter_normals(neighbours_, area_, options_.similarity_angle, options_.settled_angle, normals_);
    write_vertex_normals(mesh_, normals_, true);
    return turning;
}

} // namespace hsdm
