#pragma once
// What phase 3 leaves on the mesh's vertices: class, and one to three normals (section 3.3, Fig. 11).

#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/vertex_class.hh"

#include <OpenMesh/Core/IO/SR_store.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include <array>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>

namespace hsdm {

/// The names of the mesh properties; part of the command's contract.
inline constexpr const char* vertex_class_property = "hsdm_vertex_class"; ///< std::uint8_t, a VertexClass
inline constexpr const char* normal_count_property = "hsdm_normal_count"; ///< std::uint8_t, 0 (isolated) to 3
inline constexpr const char* vertex_normals_property = "hsdm_normals";    ///< VertexNormalsT<Mesh>
inline constexpr const char* level_property = "hsdm_level"; ///< octree level of the vertex's voxel

/// The name of one of the nine numbers of `hsdm_normals`, where each is a property of its own: i / 3 is the
/// normal, i % 3 the coordinate.
inline std::string vertex_normal_component(std::size_t i) {
    return std::string(vertex_normals_property) + "_" + std::to_string(i / 3) + "_" + "xyz"[i % 3];
}

/// A vertex's unit normals, the most significant first; those beyond its count are zero.
template <class Normal>
using NormalTriple = std::array<Normal, 3>;
template <class Mesh>
using VertexNormalsT = NormalTriple<typename Mesh::Normal>;

/// The named property, added if the mesh does not have it, and kept in .om files. The memory of a new one is
/// touched by all threads, which OpenMesh's own way to add it would do on one, unasked.
template <class T, class Mesh>
OpenMesh::VProp<T> kept_vertex_property(Mesh& mesh, const char* name) {
    if (OpenMesh::VPropHandleT<T> handle; !mesh.get_property_handle(handle, name)) {
        auto property = std::make_unique<OpenMesh::PropertyT<T>>(name, OpenMesh::get_type_name<T>());
        resize_large(property->data_vector(), mesh.n_vertices());
        mesh._add_vprop(property.get());
        static_cast<void>(property.release()); // the mesh has it now
    }
    OpenMesh::VProp<T> property(mesh, name);
    mesh.property(property.getRawProperty()).set_persistent(true);
    return property;
}

} // namespace hsdm

/// Lets .om files hold `hsdm_normals`: OpenMesh's own point of extension.
template <class Scalar>
struct OpenMesh::IO::binary<std::array<OpenMesh::VectorT<Scalar, 3>, 3>> {
    using value_type = std::array<OpenMesh::VectorT<Scalar, 3>, 3>;
    static const bool is_streamable = true;
    static std::size_t size_of() { return 9 * sizeof(Scalar); }
    static std::size_t size_of(const value_type&) { return size_of(); }
    static std::string type_identifier() { return binary<Scalar>::type_identifier() + "[3][3]"; }
    static std::size_t store(std::ostream& os, const value_type& value, bool swap = false, bool = true) {
        std::size_t bytes = 0;
        for (const auto& vector : value)
            for (std::size_t i = 0; i < 3; ++i) bytes += binary<Scalar>::store(os, vector[i], swap);
        return bytes;
    }
    static std::size_t restore(std::istream& is, value_type& value, bool swap = false, bool = true) {
        std::size_t bytes = 0;
        for (auto& vector : value)
            for (std::size_t i = 0; i < 3; ++i) bytes += binary<Scalar>::restore(is, vector[i], swap);
        return bytes;
    }
};
