#pragma once
// A mesh for renderers that know one normal a vertex: on creases a vertex for each side.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The same facets over vertices of which each has one normal: a vertex whose facets are parted by sharp
/// edges is there once for each part, with the normal of `hsdm_normals` (where the mesh has them) nearest to
/// the part's facets, else with theirs, weighted by their angles there. Others keep their normals; a mesh
/// without normals stays whole. Isolated vertices are left out, properties go along, sharp edges do not. By
/// vertex, the parts in the order of their corners; `origin` is the vertex each comes from. O(corners log
/// corners).
PolygonMesh split_creases(const PolygonMesh& mesh);

} // namespace hsdm
