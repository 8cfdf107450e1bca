#pragma once
// The phases of Figure 3 as geometry to look at: the voxels of a level, the edges of a connectivity graph.

#include "hsdm/graph/connectivity_graph.hh"
#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// Fig. 3b: every occupied voxel as a cube of six quads, outward, in the cloud's coordinates. Cubes share no
/// vertices, so each is a closed surface of its own.
PolygonMesh voxel_cubes(const Octree& octree, const OctreeLevel& level);

/// Fig. 3c: the graph as OBJ text, a vertex per voxel and an `l` line per edge, in the cloud's coordinates.
std::string graph_obj(const Octree& octree, const ConnectivityGraph& graph);

/// Writes `voxels.obj`, `graph.obj` and `facets.off` into a folder, which is made if it is not there.
/// Throws Error.
void write_phases(const std::string& folder, const Octree& octree, const OctreeLevel& level,
                  const ConnectivityGraph& graph, const PolygonMesh& facets);

} // namespace hsdm
