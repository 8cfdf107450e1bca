#pragma once
// Leaves are cubes: over flat ground, along straight creases and along cylinders fewer vertices do than there
// are leaves.

#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/mesh_checks.hh"
#include "hsdm/simplify/quadric.hh"

namespace hsdm {

/// A mesh over the leaves of an octree, as clusters of the vertices of a finer one.
struct LeafMesh {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per fine vertex, the vertex that stands for it
};

struct DecimateOptions {
    FaultCounts faults; ///< that the leaves have already
    /// of undoing what makes something wrong, >= 1
    int rounds = bounds::rounds;
};

struct DecimatedLeaves {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per vertex of the leaves, the vertex that stands for it
    FaultCounts faults;
    FarPoints far_points;
};

/// Merges vertices by their planes, then drops those that the surface does without, where a 2-manifold
/// remains, no more is beyond the bound of `checks` and no more facets intersect than before, and cuts and
/// joins facets anew. What is merged where something is wrong has to keep closer to its planes, or stays as
/// it was, and all else is merged again; where rounds do not suffice the mesh stays as it was before them.
/// `planes`: per vertex of the leaves.
DecimatedLeaves decimate(const LeafMesh& leaves, std::vector<Quadric> planes, MeshChecks& checks,
                         const DecimateOptions& options);

} // namespace hsdm
