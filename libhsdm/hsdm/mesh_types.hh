#pragma once
// The OpenMesh mesh a reconstruction returns. Only mesh building, features and their users include this.

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>

namespace hsdm {

/// Double points and normals; status bits (feature, deleted, locked) on vertices, edges and faces.
struct MeshTraits : OpenMesh::DefaultTraitsDouble {
    VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
};

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<MeshTraits>;

} // namespace hsdm
