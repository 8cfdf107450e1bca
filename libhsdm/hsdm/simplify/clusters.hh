#pragma once
// Clusters of a fine mesh's vertices, cell by cell: each connected piece of the surface in a cell may become
// one vertex.

#include "hsdm/simplify/cell_tree.hh"
#include "hsdm/simplify/quadric.hh"

namespace hsdm {

/// The clusters of one level. On the deepest level every vertex is one.
struct ClusterLevel {
    std::vector<Index> cell;
    std::vector<Index> parent; ///< cluster of the level above, no_index if the cell there cannot be whole
    std::vector<Vec3> positions;
    std::size_t size() const { return positions.size(); }
};

/// From the deepest level up: clusters of sibling cells that the surface connects inside their parent cell
/// form one cluster there. A cell stays whole if each of its clusters can be one vertex: a point meets its
/// planes within `tolerance` (root mean square, the mesh's units), and the cluster's piece of the surface can
/// shrink to a point (connected, Euler characteristic 1), so that replacing it by a vertex changes no
/// topology. Clears `whole` of the other cells. `planes`: per vertex. O(vertices * levels), parallel in
/// parts.
std::vector<ClusterLevel> build_clusters(const PolygonMesh& mesh, CellTree& tree,
                                         std::span<const Quadric> planes, double tolerance);

} // namespace hsdm
