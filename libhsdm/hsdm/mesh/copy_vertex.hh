#pragma once
// A vertex once more, with all that belongs to it.

#include "hsdm/core/large_vector.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Appends a copy of vertex `source`, its normal and properties; returns the new vertex.
inline Index copy_vertex(PolygonMesh& mesh, Index source) {
    const auto copy = [source](auto& values) {
        const auto value = values[source];
        push_large(values, value);
    };
    copy(mesh.positions);
    if (!mesh.normals.empty()) copy(mesh.normals);
    if (!mesh.origin.empty()) copy(mesh.origin);
    for (VertexProperty& property : mesh.properties) copy(property.values);
    return static_cast<Index>(mesh.vertex_count() - 1);
}

} // namespace hsdm
