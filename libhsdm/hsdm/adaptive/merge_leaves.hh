#pragma once
// Leaves are cubes: over flat ground, along straight creases and along cylinders fewer vertices do than there
// are leaves.

#include "hsdm/adaptive/bound_check.hh"
#include "hsdm/adaptive/quadric.hh"

namespace hsdm {

/// A mesh over the leaves of an octree, as clusters of the vertices of a finer one.
struct LeafMesh {
    PolygonMesh mesh;
    std::vector<Index> vertex;     ///< per fine vertex, the vertex that stands for it
    std::vector<std::uint8_t> own; ///< per vertex, is it one of the fine mesh?
};

struct MergeLeavesOptions {
    double tolerance = 0; ///< the mesh's units, > 0: what a vertex may miss planes by, root mean square
    std::size_t faults =
        0;           ///< facets that intersect and places beyond the bound that the leaves have already
    int rounds = 24; ///< of undoing what makes something wrong, >= 1
};

struct MergedLeaves {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per vertex of the leaves, the vertex that stands for it
    FarPoints far_points;
};

/// Merges vertices where that takes nothing out of the bound of `check` and makes no facets intersect, and
/// cuts and joins facets anew. Where it does, nothing merges into the vertices there, and all is merged anew;
/// if rounds do not suffice the result is the mesh over the leaves. `planes`: per vertex of the fine mesh.
MergedLeaves merge_leaves(const LeafMesh& leaves, std::span<const Quadric> planes, BoundCheck& check,
                          const MergeLeavesOptions& options);

} // namespace hsdm
