#pragma once
// Phase 2a, section 3.2.1: the connectivity graph G, dual to the occupied voxels, as a doubly-connected edge
// list.

#include "hsdm/basic/neighbor_choice.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Vertices and half-edges. The half-edges out of vertex v are first_edge[v] .. first_edge[v + 1], by
/// ascending end vertex; a half-edge and its twin join the same two vertices.
struct ConnectivityGraph {
    std::vector<Vec3> positions; ///< vertex position, relative to the octree's origin
    std::vector<Index> first_edge{0};
    std::vector<Index> end;   ///< per half-edge
    std::vector<Index> twin;  ///< per half-edge
    std::vector<Index> voxel; ///< per vertex, its voxel in the level the graph was taken from

    std::size_t vertex_count() const { return positions.size(); }
    std::size_t half_edge_count() const { return end.size(); }
    Index start(Index half_edge) const { return end[twin[half_edge]]; }
    /// The half-edge from one vertex to another, or no_index. O(rank): ranks are small.
    Index find(Index from, Index to) const {
        for (Index h = first_edge[from]; h < first_edge[from + 1]; ++h)
            if (end[h] == to) return h;
        return no_index;
    }
};

struct GraphOptions {
    NeighborChoiceOptions neighbors;
    /// The paper connects each vertex with the vertices it chose and calls every edge bi-directional: one
    /// choice makes the edge. True asks for both ends' choice instead.
    bool mutual = false;
};

/// Basic graph (Fig. 4): a vertex per voxel at the centroid of its points, edges by the four-neighbour rule.
/// O(n) time and space, parallel, the same for any number of threads. Throws OptionError.
ConnectivityGraph extract_graph(const Octree& octree, const OctreeLevel& level,
                                const GraphOptions& options = {});

} // namespace hsdm
