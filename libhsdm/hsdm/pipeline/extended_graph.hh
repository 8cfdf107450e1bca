#pragma once
// Section 3.4.2: the connectivity graph of points with normals, to inspect and to write out as in Figure 3c.

#include "hsdm/basic/connectivity_graph.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The extended graph as a doubly-connected edge list: a vertex for each sheet of a voxel, one for sheets
/// that meet in a crease; an edge where two such vertices are joined across a voxel face under normal
/// consistency. These are the edges of the facets, so it is read off them. `voxel` holds a voxel per vertex.
/// O(n log n).
ConnectivityGraph extended_graph(const PolygonMesh& facets, const std::vector<Index>& voxel);

} // namespace hsdm
