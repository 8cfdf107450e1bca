#pragma once
// From an OpenMesh mesh of any kind to flat arrays, and what has to be renewed when its points have moved.

#include "hsdm/features/VertexFanT.hh"
#include "hsdm/features/half_edges.hh"
#include "hsdm/mesh/vertex_normals.hh"

namespace hsdm {

/// The mesh's half-edges. Sharp edges are those with the status bit `feature`; vertices with that bit, locked
/// ones and those of the class corner are pinned. The mesh must have status bits of vertices, edges and
/// faces. O(half-edges), parallel.
template <class Mesh>
HalfEdges half_edges_of(const Mesh& mesh);

/// Computes again, from the facets as they are, the normals that the mesh has: of facets, of vertices (means
/// by the facets' angles) and `hsdm_normals` with `hsdm_normal_count`. The mesh must have status bits of
/// vertices and edges. O(corners), parallel.
template <class Mesh>
void renew_normals(Mesh& mesh);

} // namespace hsdm

#include "hsdm/features/HalfEdgesT_impl.hh"
