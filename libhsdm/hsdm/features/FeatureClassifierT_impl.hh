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
    const std::vector<Vec3> areas = facet_area_vectors(mesh_);
    std::vector<Vec3> normals = unwritten_vector<Vec3>(areas.size());
    for_each_handle<OpenMesh::FaceHandle>(normals.size(), [&](OpenMesh::FaceHandle f) {
        normals[index_of(f)] = unit_or_zero(areas[index_of(f)]);
    });
    mark_candidates(normals);
    if (options_.confirmation_rounds > 0) confirm(areas, normals);
    FeatureCounts counts;
    counts.sharp_edges = count_sharp_edges();
    classify_vertices(normals, counts);
    if (options_.write_normals) write_vertex_normals(mesh_, normals, false);
    return counts;
}

namespace detail {

/// Whether the normals on the two sides of an edge differ by more than the angle of this cosine.
template <class Mesh>
bool exceeds(const Mesh& mesh, OpenMesh::EdgeHandle e, const std::vector<Vec3>& facet_normals,
             double cosine) {
    const auto f0 = mesh.face_handle(mesh.halfedge_handle(e, 0));
    const auto f1 = mesh.face_handle(mesh.halfedge_handle(e, 1));
    if (!f0.is_valid() || !f1.is_valid()) return false;
    const Vec3& a = facet_normals[index_of(f0)];
    const Vec3& b = facet_normals[index_of(f1)];
    return a.sqrnorm() > 0 && b.sqrnorm() > 0 && (a | b) < cosine;
}

} // namespace detail

template <class Mesh>
void FeatureClassifierT<Mesh>::mark_candidates(const std::vector<Vec3>& facet_normals) {
    const double cosine = std::cos(options_.crease_angle);
    for_each_handle<OpenMesh::EdgeHandle>(mesh_.n_edges(), [&](OpenMesh::EdgeHandle e) {
        auto& status = mesh_.status(e);
        if (status.deleted() || status.locked()) return;
        status.set_feature(detail::exceeds(mesh_, e, facet_normals, cosine));
    });
}

/// Per facet, 1 for those whose normals smoothing can bring to an edge in question; empty if there is none.
template <class Mesh>
std::vector<unsigned char> FeatureClassifierT<Mesh>::facets_near_candidates() const {
    std::vector<unsigned char> near(mesh_.n_faces(), 0);
    std::vector<OpenMesh::FaceHandle> ring, next;
    const auto add = [&](OpenMesh::FaceHandle f, std::vector<OpenMesh::FaceHandle>& to) {
        if (!f.is_valid() || near[index_of(f)]) return;
        near[index_of(f)] = 1;
        to.push_back(f);
    };
    const std::vector<Index> candidates = indices_where(mesh_.n_edges(), chunks::light, [&](Index e) {
        const auto& status = mesh_.status(OpenMesh::EdgeHandle(static_cast<int>(e)));
        return !status.deleted() && !status.locked() && status.feature();
    });
    for (const Index e : candidates)
        for (unsigned side : {0u, 1u})
            add(mesh_.face_handle(mesh_.halfedge_handle(OpenMesh::EdgeHandle(static_cast<int>(e)), side)),
                ring);
    if (ring.empty()) return {};
    for (int round = 1; round < options_.confirmation_rounds; ++round, ring.swap(next)) {
        next.clear();
        for (const auto f : ring)
            for (const auto h : mesh_.fh_range(f))
                add(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)), next);
    }
    return near;
}

template <class Mesh>
void FeatureClassifierT<Mesh>::confirm(const std::vector<Vec3>& areas,
                                       const std::vector<Vec3>& facet_normals) {
    const std::vector<unsigned char> near = facets_near_candidates();
    if (near.empty()) return;
    const FacetNeighbours neighbours = facet_neighbours(mesh_, StatusBits::ignore, near);
    std::vector<double> weights(areas.size());
    for_each_handle<OpenMesh::FaceHandle>(
        weights.size(), [&](OpenMesh::FaceHandle f) { weights[index_of(f)] = areas[index_of(f)].norm(); });
    std::vector<Vec3> smoothed = facet_normals;
    for (int round = 0; round < options_.confirmation_rounds; ++round)
        filter_normals(neighbours, weights, detail::confirming_similarity * options_.crease_angle, 0,
                       smoothed);
    const double cosine = std::cos(detail::confirmed_share * options_.crease_angle);
    for_each_handle<OpenMesh::EdgeHandle>(mesh_.n_edges(), [&](OpenMesh::EdgeHandle e) {
        auto& status = mesh_.status(e);
        if (status.deleted() || status.locked() || !status.feature()) return;
        status.set_feature(detail::exceeds(mesh_, e, smoothed, cosine));
    });
}

template <class Mesh>
std::size_t FeatureClassifierT<Mesh>::count_sharp_edges() const {
    std::atomic<std::size_t> count = 0;
    for_chunks(mesh_.n_edges(), chunks::light, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::size_t here = 0;
        for (; begin != end; ++begin) {
            const auto& status = mesh_.status(OpenMesh::EdgeHandle(static_cast<int>(begin)));
            here += !status.deleted() && status.feature();
        }
        count += here;
    });
    return count;
}

template <class Mesh>
void FeatureClassifierT<Mesh>::classify_vertices(const std::vector<Vec3>& facet_normals,
                                                 FeatureCounts& counts) {
    auto classes = kept_vertex_property<std::uint8_t>(mesh_, vertex_class_property);
    std::array<std::atomic<std::size_t>, 3> count{};
    for_chunks(mesh_.n_vertices(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        VertexFanT<Mesh> fan(mesh_, facet_normals);
        std::array<std::size_t, 3> here{};
        for (std::size_t i = begin; i != end; ++i) {
            const OpenMesh::VertexHandle v(static_cast<int>(i));
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
