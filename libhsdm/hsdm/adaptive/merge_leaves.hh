#pragma once
// Leaves are cubes: over flat ground, along straight creases and along cylinders fewer vertices do than there
// are leaves.

#include "hsdm/adaptive/bound_check.hh"
#include "hsdm/adaptive/crossing_check.hh"
#include "hsdm/adaptive/quadric.hh"
#include "hsdm/adaptive/surface_band.hh"

namespace hsdm {

/// A mesh over the leaves of an octree, as clusters of the vertices of a finer one.
struct LeafMesh {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per fine vertex, the vertex that stands for it
};

/// What is asked of one mesh after the other, and in part remembered.
struct RoundChecks {
    /// As BoundCheck; `tolerance`, the mesh's units, > 0: what a vertex may miss planes by, root mean square,
    /// and edges the fine surface.
    RoundChecks(const PolygonMesh& fine_mesh, std::span<const Vec3> points, double bound_to_keep,
                double spacing, double tolerance)
        : bound(fine_mesh, points, bound_to_keep, spacing),
          fine(bound.to_fine(), tolerance, fine_mesh.vertex_count()) {}
    RoundChecks(const RoundChecks&) = delete;

    BoundCheck bound;
    CrossingCheck crossing;
    SurfaceBand fine;
};

/// What is wrong with a mesh.
struct FaultCounts {
    std::size_t crossing = 0; ///< pairs of facets that intersect
    std::size_t distant = 0;  ///< places, vertices and points beyond the bound
};

struct MergeLeavesOptions {
    FaultCounts faults; ///< that the leaves have already
    int rounds = 24;    ///< of undoing what makes something wrong, >= 1
};

struct MergedLeaves {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per vertex of the leaves, the vertex that stands for it
    FarPoints far_points;
};

/// Merges vertices where a 2-manifold remains, no more is beyond the bound of `checks` and no more facets
/// intersect than before, and cuts and joins facets anew. What is merged where something is wrong has to keep
/// closer to its planes, or stays as it was, and all is merged anew; if rounds do not suffice the result is
/// the mesh over the leaves. `planes`: per vertex of the fine mesh.
MergedLeaves merge_leaves(const LeafMesh& leaves, std::span<const Quadric> planes, RoundChecks& checks,
                          const MergeLeavesOptions& options);

} // namespace hsdm
