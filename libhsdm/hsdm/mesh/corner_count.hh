#pragma once
// How many corners a facet of a half-edge mesh has.

#include <OpenMesh/Core/Mesh/Handles.hh>

namespace hsdm {

/// What valence() says, which looks at each handle on its way from outside: five times as long. O(corners).
template <class Mesh>
unsigned corner_count(const Mesh& mesh, OpenMesh::FaceHandle f) {
    const auto last = mesh.halfedge_handle(f);
    unsigned count = 1;
    for (auto h = mesh.next_halfedge_handle(last); h != last; h = mesh.next_halfedge_handle(h)) ++count;
    return count;
}

} // namespace hsdm
