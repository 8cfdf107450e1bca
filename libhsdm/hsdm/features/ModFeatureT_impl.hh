#pragma once

#include "hsdm/features/VertexFanT.hh"
#include "hsdm/mesh/vertex_class.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {

/// The sharpest of the unmarked edges among some facets, and whether all of these have an area.
template <class MeshT>
struct ModFeatureT<MeshT>::Bend {
    double least_cosine = 1; ///< of the angle between the normals on both sides
    bool has_areas = true;

    /// Of an edge between two facets; a normal is zero where there is no facet.
    void add(const Vec3& a, const Vec3& b, bool marked) {
        if (!marked && a.sqrnorm() > 0 && b.sqrnorm() > 0) least_cosine = std::min(least_cosine, a | b);
    }
};

template <class MeshT>
void ModFeatureT<MeshT>::set_options(const FeatureOptions& options) {
    validate(options);
    options_ = options;
}

template <class MeshT>
void ModFeatureT<MeshT>::initialize() {
    has_classes_ = mesh_.get_property_handle(classes_, vertex_class_property);
}

template <class MeshT>
bool ModFeatureT<MeshT>::is_marked(typename MeshT::HalfedgeHandle h) const {
    return mesh_.status(mesh_.edge_handle(h)).feature();
}

template <class MeshT>
bool ModFeatureT<MeshT>::is_corner(typename MeshT::VertexHandle v) const {
    return has_classes_ && mesh_.property(classes_, v) == static_cast<std::uint8_t>(VertexClass::corner);
}

template <class MeshT>
Vec3 ModFeatureT<MeshT>::corner_at(typename MeshT::VertexHandle v) const {
    return to_vec3(mesh_.point(v));
}

template <class MeshT>
Vec3 ModFeatureT<MeshT>::normal_of(typename MeshT::FaceHandle f) const {
    if (!f.is_valid()) return {0, 0, 0};
    const auto h = mesh_.halfedge_handle(f);
    const Vec3 a = corner_at(mesh_.from_vertex_handle(h));
    const Vec3 b = corner_at(mesh_.to_vertex_handle(h));
    const Vec3 c = corner_at(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)));
    return unit_or_zero((b - a) % (c - a));
}

/// Whether the vertex that goes is on no crease and no boundary, or moves along the one it is on.
template <class MeshT>
bool ModFeatureT<MeshT>::keeps_curve(const CollapseInfo& collapse) const {
    if (is_corner(collapse.v0)) return false;
    int marked = 0, open = 0;
    bool along = false;
    Vec3 turn(0, 0, 0); // twice what the curve's two edges have in common, were it straight: none
    for (const auto h : mesh_.voh_range(collapse.v0)) {
        const bool is_open = mesh_.is_boundary(mesh_.edge_handle(h));
        if (!is_marked(h) && !is_open) continue;
        marked += is_marked(h);
        open += is_open;
        along = along || h == collapse.v0v1;
        if (h != collapse.v0v1) turn = corner_at(collapse.v0) - corner_at(mesh_.to_vertex_handle(h));
    }
    if (marked + open == 0) return !mesh_.status(collapse.v0).feature();
    if (!along || marked + open != 2 || marked == open) return false;
    return angle_between(turn, corner_at(collapse.v1) - corner_at(collapse.v0)) <= options_.corner_angle;
}

/// Whether no two marked edges become one.
template <class MeshT>
bool ModFeatureT<MeshT>::keeps_curves_apart(const CollapseInfo& collapse) const {
    return !(collapse.vl.is_valid() && is_marked(collapse.v0vl) && is_marked(collapse.vlv1))
           && !(collapse.vr.is_valid() && is_marked(collapse.vrv0) && is_marked(collapse.v1vr));
}

template <class MeshT>
typename ModFeatureT<MeshT>::Bend ModFeatureT<MeshT>::bend_before(const CollapseInfo& collapse) const {
    Bend bend;
    for (const auto h : mesh_.voh_range(collapse.v0)) {
        const auto rim = mesh_.next_halfedge_handle(h);
        const Vec3 normal = normal_of(mesh_.face_handle(h));
        bend.add(normal, normal_of(mesh_.opposite_face_handle(h)), is_marked(h));
        if (mesh_.face_handle(h).is_valid())
            bend.add(normal, normal_of(mesh_.opposite_face_handle(rim)), is_marked(rim));
    }
    return bend;
}

template <class MeshT>
typename ModFeatureT<MeshT>::Bend ModFeatureT<MeshT>::bend_after(const CollapseInfo& collapse) const {
    const Vec3 tip = corner_at(collapse.v1);
    Bend bend;
    // The facets that stay, each with the spoke that leads to it; the two that vanish hand on what is behind.
    Vec3 last = collapse.vl.is_valid() ? normal_of(mesh_.face_handle(collapse.vlv1)) : Vec3(0, 0, 0);
    bool last_marked = collapse.vl.is_valid() && (is_marked(collapse.vlv1) || is_marked(collapse.v0vl));
    for (auto h = mesh_.ccw_rotated_halfedge_handle(collapse.v0v1); h != collapse.v0v1;
         h = mesh_.ccw_rotated_halfedge_handle(h)) {
        const auto rim = mesh_.next_halfedge_handle(h);
        const auto spoke = mesh_.ccw_rotated_halfedge_handle(h);
        Vec3 normal(0, 0, 0);
        if (spoke == collapse.v0v1) { // the facet on the right of the collapse vanishes
            if (collapse.vr.is_valid()) normal = normal_of(mesh_.face_handle(collapse.v1vr));
        } else if (mesh_.face_handle(h).is_valid()) {
            const Vec3 a = corner_at(mesh_.to_vertex_handle(h));
            normal = unit_or_zero((a - tip) % (corner_at(mesh_.to_vertex_handle(rim)) - tip));
            bend.has_areas = bend.has_areas && normal.sqrnorm() > 0;
            bend.add(normal, normal_of(mesh_.opposite_face_handle(rim)), is_marked(rim));
        }
        const bool merges = spoke == collapse.v0v1 && collapse.vr.is_valid() && is_marked(collapse.v1vr);
        bend.add(last, normal, last_marked || is_marked(h) || merges);
        last = normal;
        last_marked = false;
    }
    return bend;
}

template <class MeshT>
float ModFeatureT<MeshT>::collapse_priority(const CollapseInfo& collapse) {
    if (!keeps_curve(collapse) || !keeps_curves_apart(collapse)) return float(Base::ILLEGAL_COLLAPSE);
    const Bend after = bend_after(collapse);
    if (!after.has_areas) return float(Base::ILLEGAL_COLLAPSE);
    const bool is_blunt = after.least_cosine >= std::cos(options_.crease_angle)
                          || after.least_cosine >= bend_before(collapse).least_cosine;
    return float(is_blunt ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE);
}

template <class MeshT>
void ModFeatureT<MeshT>::preprocess_collapse(const CollapseInfo& collapse) {
    const auto merge = [&](typename MeshT::HalfedgeHandle a, typename MeshT::HalfedgeHandle b) {
        const bool marked = is_marked(a) || is_marked(b);
        mesh_.status(mesh_.edge_handle(a)).set_feature(marked);
        mesh_.status(mesh_.edge_handle(b)).set_feature(marked);
    };
    if (collapse.vl.is_valid()) merge(collapse.v0vl, collapse.vlv1);
    if (collapse.vr.is_valid()) merge(collapse.vrv0, collapse.v1vr);
}

} // namespace hsdm
