#pragma once

#include "hsdm/features/VertexFanT.hh"
#include "hsdm/mesh/triangle_mesh.hh"
#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>
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

/// The value with which every coordinate, colour or texture coordinate begins.
template <class Value>
Value zero() {
    Value value{};
    if constexpr (!std::is_arithmetic_v<Value>) vectorize(value, 0);
    return value;
}

/// A colour of any OpenMesh type as bytes red, green, blue, alpha: fractions of 1 if its numbers are
/// floating (what is not a number is 0), opaque if it has no fourth.
template <class Color>
std::array<std::uint8_t, 4> color_bytes(const Color& color) {
    using Number = typename OpenMesh::vector_traits<Color>::value_type;
    constexpr double full = std::is_floating_point_v<Number> ? 255 : 1;
    std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
    for (std::size_t k = 0; k < std::min<std::size_t>(4, OpenMesh::vector_traits<Color>::size()); ++k) {
        const double value = std::round(full * static_cast<double>(color[k]));
        bytes[k] = value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0)) : std::uint8_t{0};
    }
    return bytes;
}

/// The other way.
template <class Color>
Color color_of(const std::array<std::uint8_t, 4>& bytes) {
    using Number = typename OpenMesh::vector_traits<Color>::value_type;
    auto color = zero<Color>();
    for (std::size_t k = 0; k < std::min<std::size_t>(4, OpenMesh::vector_traits<Color>::size()); ++k) {
        const auto byte = static_cast<Number>(bytes[k]);
        color[k] = std::is_floating_point_v<Number> ? byte / Number(255) : byte;
    }
    return color;
}

/// Whether the library reads the numbers of these vectors where they are.
template <class Vector, bool is_color = false>
constexpr bool is_readable() {
    using Number = typename OpenMesh::vector_traits<Vector>::value_type;
    constexpr std::size_t size = OpenMesh::vector_traits<Vector>::size_;
    constexpr bool is_floating = std::is_same_v<Number, float> || std::is_same_v<Number, double>;
    constexpr bool is_byte = std::is_same_v<Number, std::uint8_t>;
    return is_floating ? size == 3 || (is_color && size == 4)
                       : is_color && is_byte && (size == 3 || size == 4);
}

/// Whether it reads all of a mesh that it looks at.
template <class Mesh>
inline constexpr bool has_readable_rows = is_readable<typename Mesh::Point>()
                                          && is_readable<typename Mesh::Normal>()
                                          && is_readable<typename Mesh::Color, true>();

/// Vectors one after the other, as OpenMesh keeps them.
template <class Vector>
StridedSpan rows_of_vectors(const Vector* first, std::size_t count) {
    return {&(*first)[0], count, sizeof(Vector)};
}

/// Vertex colours from the properties that averaged colours are in; black, transparent where there are none.
template <class Mesh>
void copy_colors(const PolyMesh& from, Mesh& to) {
    if (!to.has_vertex_colors()) return;
    std::array<OpenMesh::VPropHandleT<std::uint8_t>, 4> channels;
    std::array<bool, 4> there{};
    for (std::size_t k = 0; k < 4; ++k) there[k] = from.get_property_handle(channels[k], color_properties[k]);
    for (const auto v : from.vertices()) {
        std::array<std::uint8_t, 4> bytes{};
        for (std::size_t k = 0; k < 4; ++k)
            if (there[k]) bytes[k] = from.property(channels[k], v);
        to.set_color(v, color_of<typename Mesh::Color>(bytes));
    }
}

/// What a reconstruction says nothing of is zero: OpenMesh leaves it uninitialised.
template <class Mesh>
void clear_other_attributes(Mesh& to) {
    const auto color = zero<typename Mesh::Color>();
    const auto place_1d = zero<typename Mesh::TexCoord1D>();
    const auto place_2d = zero<typename Mesh::TexCoord2D>();
    const auto place_3d = zero<typename Mesh::TexCoord3D>();
    for (const auto v : to.vertices()) {
        if (to.has_vertex_texcoords1D()) to.set_texcoord1D(v, place_1d);
        if (to.has_vertex_texcoords2D()) to.set_texcoord2D(v, place_2d);
        if (to.has_vertex_texcoords3D()) to.set_texcoord3D(v, place_3d);
    }
    for (const auto h : to.halfedges()) {
        if (to.has_halfedge_texcoords1D()) to.set_texcoord1D(h, place_1d);
        if (to.has_halfedge_texcoords2D()) to.set_texcoord2D(h, place_2d);
        if (to.has_halfedge_texcoords3D()) to.set_texcoord3D(h, place_3d);
        if (to.has_halfedge_normals()) to.set_normal(h, zero<typename Mesh::Normal>());
        if (to.has_halfedge_colors()) to.set_color(h, color);
    }
    for (const auto e : to.edges())
        if (to.has_edge_colors()) to.set_color(e, color);
    for (const auto f : to.faces()) {
        if (to.has_face_colors()) to.set_color(f, color);
        if (to.has_face_texture_index()) to.set_texture_index(f, 0);
    }
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
    detail::copy_colors(from, to);
    detail::clear_other_attributes(to);
    detail::copy_properties(from, to);
}

template <class Mesh>
void ReconstructorT<Mesh>::initialize(const ReconstructOptions& options) {
    options_ = options;
    is_initialized_ = true;
}

/// Whether one of the vertices has a normal that is not zero: a mesh may have room for them and none.
template <class Mesh>
bool ReconstructorT<Mesh>::has_normals() const {
    if (!mesh_.has_vertex_normals()) return false;
    const auto vertices = mesh_.vertices();
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](const auto v) { return to_vec3(mesh_.normal(v)).sqrnorm() > 0; });
}

/// Deleted vertices stand among the others until garbage is collected.
template <class Mesh>
bool ReconstructorT<Mesh>::can_be_viewed() const {
    if (!detail::has_readable_rows<Mesh> || mesh_.n_vertices() == 0) return false;
    if (!mesh_.has_vertex_status()) return true;
    for (int v = 0; v < static_cast<int>(mesh_.n_vertices()); ++v)
        if (mesh_.status(OpenMesh::VertexHandle(v)).deleted()) return false;
    return true;
}

template <class Mesh>
PointView ReconstructorT<Mesh>::view() const {
    PointView view;
    if constexpr (detail::has_readable_rows<Mesh>) {
        using Color = typename Mesh::Color;
        view.positions = detail::rows_of_vectors(mesh_.points(), mesh_.n_vertices());
        if (has_normals()) view.normals = detail::rows_of_vectors(mesh_.vertex_normals(), mesh_.n_vertices());
        if (mesh_.has_vertex_colors())
            view.colors = detail::rows_of_vectors(mesh_.vertex_colors(), mesh_.n_vertices());
        view.color_channels = static_cast<int>(OpenMesh::vector_traits<Color>::size());
    }
    return view;
}

template <class Mesh>
PointCloud ReconstructorT<Mesh>::copied() const {
    PointCloud cloud;
    cloud.positions.reserve(mesh_.n_vertices());
    for (const auto v : mesh_.vertices()) cloud.positions.push_back(to_vec3(mesh_.point(v)));
    if (mesh_.has_vertex_colors())
        for (const auto v : mesh_.vertices()) cloud.colors.push_back(detail::color_bytes(mesh_.color(v)));
    if (has_normals())
        for (const auto v : mesh_.vertices()) cloud.normals.push_back(to_vec3(mesh_.normal(v)));
    return cloud;
}

template <class Mesh>
Report ReconstructorT<Mesh>::reconstruct() {
    if (!is_initialized_) throw std::logic_error("ReconstructorT: reconstruct() called before initialize()");
    Reconstruction result =
        can_be_viewed() ? hsdm::reconstruct(view(), options_) : hsdm::reconstruct(copied(), options_);
    result.mesh.garbage_collection();
    if constexpr (Mesh::is_trimesh())
        copy_mesh(triangle_mesh(result.mesh), mesh_);
    else
        copy_mesh(result.mesh, mesh_);
    return std::move(result.report);
}

} // namespace hsdm
