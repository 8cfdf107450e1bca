#pragma once

#include "hsdm/features/VertexFanT.hh"

#include <atomic>
#include <cmath>
#include <stdexcept>

namespace hsdm {

template <class Mesh>
FeatureClassifierT<Mesh>::FeatureClassifierT(Mesh& mesh) : mesh_(mesh) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
}

template <class Mesh>
FeatureClassifierT<Mesh>::~FeatureClassifierT() {
    mesh_.release_face_status();
    mesh_.release_edge_status();
    mesh_.release_vertex_status();
}

template <class Mesh>
void FeatureClassifierT<Mesh>::initialize(const FeatureOptions& options) {
    validate(options);
    options_ = options;
    is_initialized_ = true;
}

template <class Mesh>
FeatureCounts FeatureClassifierT<Mesh>::classify() {
    if (!is_initialized_) throw std::logic_error("FeatureClassifierT: classify() called before initialize()");
    std::vector<Vec3> normals = facet_area_vectors(mesh_);
    for_each_handle<OpenMesh::FaceHandle>(normals.size(), [&](OpenMesh::FaceHandle f) {
        normals[index_of(f)] = unit_or_zero(normals[index_of(f)]);
    });
    FeatureCounts counts;
    counts.sharp_edges = mark_sharp_edges(normals);
    classify_vertices(normals, counts);
    write_vertex_normals(mesh_, normals, false);
    return counts;
}

template <class Mesh>
std::size_t FeatureClassifierT<Mesh>::mark_sharp_edges(const std::vector<Vec3>& facet_normals) {
    const double limit = std::cos(options_.crease_angle);
    std::atomic<std::size_t> count = 0;
    for_each_handle<OpenMesh::EdgeHandle>(mesh_.n_edges(), [&](OpenMesh::EdgeHandle e) {
        auto& status = mesh_.status(e);
        if (status.deleted()) return;
        if (!status.locked()) {
            const auto f0 = mesh_.face_handle(mesh_.halfedge_handle(e, 0));
            const auto f1 = mesh_.face_handle(mesh_.halfedge_handle(e, 1));
            bool sharp = f0.is_valid() && f1.is_valid();
            if (sharp) {
                const Vec3& a = facet_normals[index_of(f0)];
                const Vec3& b = facet_normals[index_of(f1)];
                sharp = a.sqrnorm() > 0 && b.sqrnorm() > 0 && (a | b) < limit;
            }
            status.set_feature(sharp);
        }
        if (status.feature()) ++count;
    });
    return count;
}

template <class Mesh>
void FeatureClassifierT<Mesh>::classify_vertices(const std::vector<Vec3>& facet_normals,
                                                 FeatureCounts& counts) {
    auto classes = kept_vertex_property<std::uint8_t>(mesh_, vertex_class_property);
    std::array<std::atomic<std::size_t>, 3> count{};
    tbb::parallel_for(
        tbb::blocked_range<int>(0, static_cast<int>(mesh_.n_vertices()), 1 << 11), [&](const auto& range) {
            VertexFanT<Mesh> fan(mesh_, facet_normals);
            std::array<std::size_t, 3> here{};
            for (int i = range.begin(); i != range.end(); ++i) {
                const OpenMesh::VertexHandle v(i);
                auto& status = mesh_.status(v);
                if (status.deleted()) continue;
                fan.gather(v);
                const VertexClass kind = vertex_class(fan.sharp_edges(), fan.turn(), options_.corner_angle);
                classes[v] = static_cast<std::uint8_t>(kind);
                if (!status.locked()) status.set_feature(kind != VertexClass::smooth);
                if (!mesh_.is_isolated(v)) ++here[static_cast<std::size_t>(kind)];
            }
            for (std::size_t k = 0; k < 3; ++k) count[k] += here[k];
        });
    counts.smooth_vertices = count[0];
    counts.edge_vertices = count[1];
    counts.corner_vertices = count[2];
}

} // namespace hsdm
