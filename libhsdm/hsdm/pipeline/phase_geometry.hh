#pragma once
// The phases of Figure 3 as geometry to look at: the voxels of a level, the edges of a connectivity graph.

#include "hsdm/basic/connectivity_graph.hh"
#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// Fig. 3b: every occupied voxel as a cube of six quads, outward, in the cloud's coordinates. Cubes share no
/// vertices, so each is a closed surface of its own.
PolygonMesh voxel_cubes(const Octree& octree, const OctreeLevel& level, const CloudFrame& frame = {});

/// Fig. 3c: the graph as OBJ text, a vertex per voxel and an `l` line per edge, in the cloud's coordinates.
std::string graph_obj(const Octree& octree, const ConnectivityGraph& graph, const CloudFrame& frame = {});

/// What write_phases() writes for a level of this depth: `d5/voxels.obj` etc. in the folder.
struct PhaseFiles {
    std::string folder, voxels, graph, facets;
};
PhaseFiles phase_files(const std::string& debug_dir, int depth);

/// Writes the three files of the level into these; folders are made where there are none. The octree and the
/// facets lie in the frame. Throws Error.
void write_phases(const PhaseFiles& files, const Octree& octree, const OctreeLevel& level,
                  const ConnectivityGraph& graph, const PolygonMesh& facets, const CloudFrame& frame = {});

} // namespace hsdm
