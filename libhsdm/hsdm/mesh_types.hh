#pragma once
// The OpenMesh mesh a reconstruction returns. Only mesh building, features and their users include this.

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>

namespace hsdm {

/// Double points and normals; status bits (feature, deleted, locked) on vertices, edges and faces.
struct MeshTraits : OpenMesh::DefaultTraitsDouble {
    /// A normal and status bits per vertex.
    VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    /// Status bits per edge.
    EdgeAttributes(OpenMesh::Attributes::Status);
    /// A normal and status bits per facet.
    FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
};

/// Half-edge mesh of polygons with these traits.
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<MeshTraits>;

} // namespace hsdm
