#pragma once
// Vertices where no points are.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Draws vertices that stand out like spikes back to the points. Where sheets were misjudged their planes go
/// on to where nothing is; a vertex farther from every point than the sampling can leave one (half of a
/// voxel's diagonal, or two spacings of the points around it) moves half of the way to the mean of its
/// neighbours, until it is not far any more. Topology and all other vertices stay. `voxel`: per origin of a
/// vertex the occupied voxel that it stands for. Returns how many were moved. O(corners of the mesh) if there
/// are any, else O(vertices); parallel, the same for any number of threads.
std::size_t draw_in_spikes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                           PolygonMesh& mesh);

} // namespace hsdm
