#pragma once
// Decimates the mesh over the leaves: leaves are cubes, but flat ground, straight creases and cylinders need
// fewer vertices than there are leaves.

#include "hsdm/core/constants.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/mesh_checks.hh"
#include "hsdm/simplify/quadric.hh"

namespace hsdm {

/// A mesh whose vertices stand for clusters of the vertices of a finer one: in a leaf each, or larger ones.
struct ClusteredMesh {
    PolygonMesh mesh;          ///< `origin`: per vertex one of the fine vertices that it stands for
    std::vector<Index> vertex; ///< per fine vertex, the vertex that stands for it
};

struct DecimateOptions {
    FaultCounts faults; ///< of the clustered mesh
    /// rounds of undoing collapses that cause faults, >= 1
    int rounds = enough_rounds;
};

struct DecimatedMesh {
    PolygonMesh mesh;
    std::vector<Index> vertex; ///< per vertex of the clustered mesh, the vertex that stands for it
    FaultCounts faults;
    FarPoints far_points;
};

/// Collapses edges by planes (collapse_by_planes), then by distance (collapse_by_distance), and remeshes by
/// flips, so that the mesh stays a 2-manifold with no more faults, found by `checks`, than `options.faults`.
/// Where a round causes faults, the vertices there get smaller tolerances or stay as they were, and the
/// collapses are repeated; if the rounds do not suffice the mesh is left as it was before that step.
/// `planes`: per vertex of the clustered mesh.
DecimatedMesh decimate(const ClusteredMesh& clustered, std::vector<Quadric> planes, MeshChecks& checks,
                       const DecimateOptions& options);

} // namespace hsdm
