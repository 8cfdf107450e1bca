#pragma once
// The four kinds of OpenMesh mesh the modules promise to work on, and solids as any of them.

#include "hsdm/polygon_mesh.hh"
#include "support/meshes.hh"
#include "support/random.hh"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <vector>

namespace hsdm::test {

using PolyMeshF = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraits>;
using PolyMeshD = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using TriMeshF = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraits>;
using TriMeshD = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// The polygons as a mesh of any kind (a triangle mesh cuts them), with the status bits results are kept in.
template <class Mesh>
Mesh build(const PolygonMesh& polygons) {
    Mesh mesh;
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_face_status();
    mesh.request_vertex_normals();
    using Point = typename Mesh::Point;
    using Scalar = typename Mesh::Scalar;
    for (const Vec3& p : polygons.positions)
        mesh.add_vertex(
            Point(static_cast<Scalar>(p[0]), static_cast<Scalar>(p[1]), static_cast<Scalar>(p[2])));
    for (std::size_t f = 0; f < polygons.facet_count(); ++f) {
        std::vector<OpenMesh::VertexHandle> corners;
        for (const Index v : polygons.facet(f)) corners.emplace_back(static_cast<int>(v));
        mesh.add_face(corners);
    }
    return mesh;
}

/// A cylinder of radius 1 and height 2 with m quads around, n up, and caps of m triangles each.
PolygonMesh capped_cylinder(Index m, Index n);
inline PolygonMesh sphere(Index n) {
    return support::divided_sphere(n);
}
/// n x n unit quads over z = height(x).
template <class Height>
PolygonMesh sheet(Index n, const Height& height) {
    return support::quad_sheet(n, n, [&](Index x, Index y) { return Vec3(x, y, height(x, y)); });
}

/// Every vertex moved by a Gauss-distributed vector.
PolygonMesh noisy(PolygonMesh mesh, double sigma);

} // namespace hsdm::test
