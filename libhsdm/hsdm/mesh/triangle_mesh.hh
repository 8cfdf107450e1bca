#pragma once
// A polygon mesh cut into triangles, with all attributes that phase 3 has written on it.

#include "hsdm/mesh_types.hh"

namespace hsdm {

/// The mesh with every polygon cut as `triangulate` cuts it: vertices in their order without deleted and
/// isolated ones, their normals, status bits and scalar properties, `hsdm_normals`, the feature bits of
/// edges. Where two facets are cut by the same diagonal its ends get a second vertex, so the result is a
/// 2-manifold if the mesh was. O(corners).
PolyMesh triangle_mesh(const PolyMesh& mesh);

} // namespace hsdm
