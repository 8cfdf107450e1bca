#pragma once

#include "hsdm/features/VertexFanT.hh"

#include <stdexcept>
#include <vector>

namespace hsdm {

template <class Mesh>
void HoleFillerT<Mesh>::initialize(const FillHolesOptions& options) {
    validate(options);
    options_ = options;
    if constexpr (Mesh::is_trimesh()) options_.quads = false;
    is_initialized_ = true;
}

/// The mesh's facets over vertices with the numbers that they have there, deleted ones too.
template <class Mesh>
PolygonMesh HoleFillerT<Mesh>::polygons() const {
    PolygonMesh polygons;
    polygons.positions.reserve(mesh_.n_vertices());
    for (const auto v : mesh_.all_vertices()) polygons.positions.push_back(to_vec3(mesh_.point(v)));
    std::vector<Index> corners;
    for (const auto f : mesh_.faces()) {
        corners.clear();
        for (const auto v : f.vertices()) corners.push_back(static_cast<Index>(v.idx()));
        polygons.add_facet(corners);
    }
    return polygons;
}

template <class Mesh>
FillHolesCounts HoleFillerT<Mesh>::fill() {
    if (!is_initialized_) throw std::logic_error("HoleFillerT: fill() called before initialize()");
    PolygonMesh filled = polygons();
    const std::size_t vertices = filled.vertex_count(), facets = filled.facet_count();
    FillHolesCounts counts = fill_holes(filled, options_);
    for (std::size_t v = vertices; v < filled.vertex_count(); ++v)
        mesh_.add_vertex(to_normal<typename Mesh::Point>(filled.positions[v]));
    std::vector<OpenMesh::VertexHandle> corners;
    for (std::size_t f = facets; f < filled.facet_count(); ++f) {
        corners.clear();
        for (const Index v : filled.facet(f)) corners.emplace_back(static_cast<int>(v));
        mesh_.add_face(corners);
    }
    return counts;
}

} // namespace hsdm
