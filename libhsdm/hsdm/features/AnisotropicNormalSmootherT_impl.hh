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
    read_neighbours();
    is_initialized_ = true;
}

template <class Mesh>
void AnisotropicNormalSmootherT<Mesh>::read_facets() {
    normals_ = facet_area_vectors(mesh_);
    area_.resize(normals_.size());
    for_each_handle<OpenMesh::FaceHandle>(normals_.size(), [&](OpenMesh::FaceHandle f) {
        Vec3& normal = normals_[index_of(f)];
        area_[index_of(f)] = 0.5 * normal.norm();
        normal = unit_or_zero(normal);
    });
}

template <class Mesh>
void AnisotropicNormalSmootherT<Mesh>::read_neighbours() {
    // Locked and deleted facets get no neighbours of their own, so their normals stay.
    const auto is_fixed = [&](OpenMesh::FaceHandle f) {
        return mesh_.status(f).deleted() || mesh_.status(f).locked();
    };
    neighbours_.first.assign(mesh_.n_faces() + 1, 0);
    for_each_handle<OpenMesh::FaceHandle>(mesh_.n_faces(), [&](OpenMesh::FaceHandle f) {
        if (!is_fixed(f)) neighbours_.first[index_of(f) + 1] = static_cast<Index>(mesh_.valence(f));
    });
    for (std::size_t f = 0; f < mesh_.n_faces(); ++f) neighbours_.first[f + 1] += neighbours_.first[f];
    neighbours_.neighbour.resize(neighbours_.first.back());
    for_each_handle<OpenMesh::FaceHandle>(mesh_.n_faces(), [&](OpenMesh::FaceHandle f) {
        if (is_fixed(f)) return;
        Index slot = neighbours_.first[index_of(f)];
        for (const auto h : mesh_.fh_range(f)) {
            const auto across = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
            const bool joined = across.is_valid() && !mesh_.status(mesh_.edge_handle(h)).feature();
            neighbours_.neighbour[slot++] = joined ? static_cast<Index>(across.idx()) : no_index;
        }
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
