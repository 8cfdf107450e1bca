#include "hsdm/mesh/vertex_properties.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace hsdm {
namespace {

/// The value as a T; an integer that cannot hold it takes its nearest limit, 0 for what is not a number.
template <class T>
T saturated(double value) {
    if constexpr (std::is_integral_v<T>) {
        if (!(value == value)) return 0;
        constexpr double lowest = std::numeric_limits<T>::lowest(), highest = std::numeric_limits<T>::max();
        return static_cast<T>(std::clamp(value, lowest, highest));
    } else {
        return static_cast<T>(value);
    }
}

/// Removes the properties of a name whose values are no T, but for OpenMesh's own, such as `v:points`.
template <class T>
void remove_others(const std::string& name, PolyMesh& mesh) {
    if (name.substr(0, 2) == "v:") return;
    int place = 0;
    for (auto it = mesh.vprops_begin(); it != mesh.vprops_end(); ++it, ++place) {
        if (*it == nullptr || (*it)->name() != name || dynamic_cast<OpenMesh::PropertyT<T>*>(*it)) continue;
        OpenMesh::VPropHandleT<T> handle(place); // what it is of does not matter to remove_property()
        mesh.remove_property(handle);
    }
}

template <class T>
void write_property(const VertexProperty& from, std::span<const Index> source, PolyMesh& mesh) {
    remove_others<T>(from.name, mesh);
    auto property = kept_vertex_property<T>(mesh, from.name.c_str());
    auto& values = mesh.property(property.getRawProperty()).data_vector();
    for_each_index(source.size(), chunks::quick,
                   [&](Index v) { values[v] = saturated<T>(from.values[source[v]]); });
}

} // namespace

void set_vertex_property(const VertexProperty& from, std::span<const Index> source, PolyMesh& mesh) {
    switch (from.type) {
    case VertexProperty::Type::uint8:
        return write_property<std::uint8_t>(from, source, mesh);
    case VertexProperty::Type::int32:
        return write_property<std::int32_t>(from, source, mesh);
    case VertexProperty::Type::float32:
        return write_property<float>(from, source, mesh);
    case VertexProperty::Type::float64:
        return write_property<double>(from, source, mesh);
    }
}

} // namespace hsdm
