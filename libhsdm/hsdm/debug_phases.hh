#pragma once
// The phases of Figure 3 as files one can look at.

#include "hsdm/graph/connectivity_graph.hh"
#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// Writes `voxels.dN.obj` (Fig. 3b, a cube of quads per occupied voxel), in the cloud's coordinates. Makes
/// the folder if it is missing. Throws Error.
void write_debug_voxels(const std::string& folder, const Octree& octree, const OctreeLevel& level);

/// Writes `graph.dN.obj` (Fig. 3c): the edges of the graph as lines.
void write_debug_graph(const std::string& folder, const Octree& octree, const OctreeLevel& level,
                       const ConnectivityGraph& graph);

/// Writes `facets.dN.off` (Fig. 3d).
void write_debug_facets(const std::string& folder, const OctreeLevel& level, const PolygonMesh& facets);

} // namespace hsdm
