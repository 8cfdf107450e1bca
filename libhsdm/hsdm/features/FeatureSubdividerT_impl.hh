#pragma once

#include "hsdm/errors.hh"
#include "hsdm/features/HalfEdgesT.hh"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace hsdm {

template <class Mesh>
FeatureSubdividerT<Mesh>::FeatureSubdividerT(Mesh& mesh) : mesh_(mesh) {
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
}

template <class Mesh>
FeatureSubdividerT<Mesh>::~FeatureSubdividerT() {
    mesh_.release_face_status();
    mesh_.release_edge_status();
    mesh_.release_vertex_status();
}

template <class Mesh>
void FeatureSubdividerT<Mesh>::initialize(const SubdivisionOptions& options) {
    validate(options);
    if (Mesh::is_trimesh() && options.scheme == SubdivisionScheme::catmull_clark)
        throw OptionError(
            "scheme catmull-clark: makes quads, which a mesh of triangles cannot hold; take loop");
    options_ = options;
    if (Mesh::is_trimesh()) options_.scheme = SubdivisionScheme::loop;
    is_initialized_ = true;
}

template <class Mesh>
SubdivisionCounts FeatureSubdividerT<Mesh>::divide() {
    if (!is_initialized_) throw std::logic_error("FeatureSubdividerT: divide() called before initialize()");
    mesh_.garbage_collection();
    HalfEdges flat = half_edges_of(mesh_);
    SubdivisionCounts counts;
    counts.scheme = scheme_for(flat, options_.scheme);
    check_numbers(flat, options_.rounds);
    counts.facets_before = mesh_.n_faces();
    std::vector<CurveRole> roles = curve_roles(flat, options_.corner_angle);
    counts.corners = static_cast<std::size_t>(std::ranges::count(roles, CurveRole::corner));
    for (int round = 0; round < options_.rounds; ++round) {
        // A corner stays one where the rounds before have made its curve's turn smaller.
        for (std::size_t v = 0; v < roles.size(); ++v)
            if (roles[v] == CurveRole::corner) flat.pins[v] = Pin::always;
        Refinement after = refined(flat, roles, counts.scheme);
        write(flat, after);
        flat = std::move(after.mesh);
        roles = curve_roles(flat, std::numbers::pi);
    }
    if (options_.rounds > 0) renew_normals(mesh_);
    counts.facets_after = mesh_.n_faces();
    counts.vertices = mesh_.n_vertices();
    counts.sharp_edges = static_cast<std::size_t>(std::ranges::count(flat.marked, 1));
    return counts;
}

template <class Mesh>
void FeatureSubdividerT<Mesh>::write(const HalfEdges& before, const Refinement& after) {
    const HalfEdges& mesh = after.mesh;
    mesh_.resize(mesh.vertex_count(), mesh.edge_count(), mesh.facet_count());
    write_links(mesh);
    inherit_edges(before.edge_count());
    for (std::size_t f = before.facet_count(); f < mesh.facet_count(); ++f)
        mesh_.copy_all_properties(OpenMesh::FaceHandle(static_cast<int>(after.parent[f])),
                                  OpenMesh::FaceHandle(static_cast<int>(f)), true);
    inherit_vertices(before, mesh);
    for_each_handle<OpenMesh::VertexHandle>(mesh.vertex_count(), [&](OpenMesh::VertexHandle v) {
        const Vec3& place = mesh.positions[index_of(v)];
        if (index_of(v) < before.vertex_count() && place == before.positions[index_of(v)]) return;
        mesh_.set_point(v, to_normal<typename Mesh::Point>(place));
    });
}

template <class Mesh>
void FeatureSubdividerT<Mesh>::write_links(const HalfEdges& mesh) {
    const auto half_edge = [](Index h) { return OpenMesh::HalfedgeHandle(static_cast<int>(h)); };
    for_each_index(mesh.to.size(), chunks::quick, [&](Index h) {
        mesh_.set_vertex_handle(half_edge(h), OpenMesh::VertexHandle(static_cast<int>(mesh.to[h])));
        mesh_.set_next_halfedge_handle(half_edge(h), half_edge(mesh.next[h]));
        mesh_.set_face_handle(half_edge(h), OpenMesh::FaceHandle(static_cast<int>(mesh.facet[h])));
    });
    for_each_handle<OpenMesh::VertexHandle>(mesh.vertex_count(), [&](OpenMesh::VertexHandle v) {
        mesh_.set_halfedge_handle(v, half_edge(mesh.out[index_of(v)]));
    });
    for_each_handle<OpenMesh::FaceHandle>(mesh.facet_count(), [&](OpenMesh::FaceHandle f) {
        mesh_.set_halfedge_handle(f, half_edge(mesh.side[index_of(f)]));
    });
}

/// The other half of each edge has what the edge has; edges inside facets have nothing.
template <class Mesh>
void FeatureSubdividerT<Mesh>::inherit_edges(std::size_t edges_before) {
    for (std::size_t i = 0; i < edges_before; ++i) {
        const OpenMesh::EdgeHandle e(static_cast<int>(i)), half(static_cast<int>(edges_before + i));
        mesh_.copy_all_properties(e, half, true);
        for (const unsigned side : {0u, 1u})
            mesh_.copy_all_properties(mesh_.halfedge_handle(e, side), mesh_.halfedge_handle(half, side),
                                      true);
    }
    for (std::size_t i = 2 * edges_before; i < mesh_.n_edges(); ++i)
        mesh_.status(OpenMesh::EdgeHandle(static_cast<int>(i))).set_bits(0);
}

template <class Mesh>
void FeatureSubdividerT<Mesh>::inherit_vertices(const HalfEdges& before, const HalfEdges& after) {
    const InheritedValues values(mesh_.vprops_begin(), mesh_.vprops_end());
    const std::size_t first_of_edges = before.vertex_count();
    const std::size_t first_of_facets = first_of_edges + before.edge_count();
    for (Index e = 0; e < before.edge_count(); ++e) {
        values.set(static_cast<Index>(first_of_edges + e), std::array{before.from(2 * e), before.to[2 * e]});
        mark_vertex(first_of_edges + e, before.marked[e]);
    }
    std::vector<Index> corners;
    for (std::size_t v = first_of_facets; v < after.vertex_count(); ++v) {
        corners.clear();
        before.for_each_side(static_cast<Index>(v - first_of_facets),
                             [&](Index h) { corners.push_back(before.to[h]); });
        values.set(static_cast<Index>(v), corners);
        mark_vertex(v, false);
    }
}

/// Status and class of a new vertex.
template <class Mesh>
void FeatureSubdividerT<Mesh>::mark_vertex(std::size_t v, bool on_crease) {
    const OpenMesh::VertexHandle handle(static_cast<int>(v));
    mesh_.status(handle).set_bits(0);
    mesh_.status(handle).set_feature(on_crease);
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    if (!mesh_.get_property_handle(classes, vertex_class_property)) return;
    mesh_.property(classes, handle) =
        static_cast<std::uint8_t>(on_crease ? VertexClass::edge : VertexClass::smooth);
}

} // namespace hsdm
