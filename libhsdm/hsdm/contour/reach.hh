#pragma once
// Points that stand out from the facets.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Moves vertices to where points stand out from the facets: tips, ends of thin ridges and rims, in voxels
/// whose planes did not say where the surface ends. `far`: voxels with points that do, ascending
/// (PlacedVertices::far). Where at least three do in a voxel and those round it, a corner of the triangle
/// nearest to the farthest moves to that point, if the sum of squared distances then falls to a half, none is
/// as far as one was, the points reached are those that the area added must have, no facet turns by a right
/// angle and no more of those round the voxel intersect. Vertices of a border, topology and all other
/// vertices stay. `voxel`: per origin of a vertex the occupied voxel that it stands for. Returns how many
/// moves were made. O(corners of the mesh + points and facets round far voxels) if there are any; the same
/// for any number of threads.
std::size_t reach_points(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                         std::span<const Index> far, PolygonMesh& mesh);

} // namespace hsdm
