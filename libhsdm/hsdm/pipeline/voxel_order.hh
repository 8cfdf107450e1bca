#pragma once
// The final order of a mesh's vertices and facets: that of voxels, so that part of a level makes part of it.

#include "hsdm/pipeline/method.hh"

namespace hsdm {

/// Numbers vertices by the voxel that each stands for, and facets by their least vertex; ties stay in the
/// order they had. Vertices of no facet are left out; facets keep their corners and where they begin. `voxel`
/// and what is known go along: links become those that link_facets() would find (none where it would split
/// vertices). The mesh has no properties, normals and origins yet. O(corners + voxels).
void order_by_voxels(std::size_t voxels, std::vector<Index>& voxel, PolygonMesh& mesh, FacetKnowledge& known);

} // namespace hsdm
