#pragma once
// The common input and output of both methods.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/contour/normal_sets.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/phases.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <optional>

namespace hsdm {

/// The input of a method: one level of a prepared cloud.
struct MethodInput {
    const CloudFrame& frame; ///< of the octree's coordinates
    const PointView& cloud;  ///< for its colours and scalars: the rest may have been freed
    const Octree& octree;
    const OctreeLevel& level;
    const ReconstructOptions& options;
    const Phases& phases;
    /// The level's normal sets where they have been made, to be taken; null or nothing where not.
    std::optional<NormalSets>* sets = nullptr;
    /// Scanners that are sure, relative to the origin of the measured points' octree.
    Viewpoints viewpoints{};
    bool has_layers = false; ///< some points took the sides of layers of one surface (take_layers)

    /// The same of other points.
    MethodInput with(const Octree& points, const OctreeLevel& their_level) const {
        return {frame, cloud, points, their_level, options, phases, nullptr, {}, has_layers};
    }
};

/// What is known about facets beyond the mesh, valid as long as they do not change.
struct FacetKnowledge {
    FeatureHints hints;
    std::optional<FacetLinks> links;
    std::optional<FacetCells> cells; ///< the voxels as cells of the facets
    Occurrences
        intersections; ///< pairs that meet, as far as the method knows; relative to the octree's origin
};

/// Adds an entry to the report's list, unless nothing was dropped. `discarded.first` lies in the frame.
void note_dropped(const std::string& what, const Occurrences& discarded, const CloudFrame& frame,
                  Report& report);

/// What closing holes and make_manifold did, as both methods report it.
void note_repairs(const FillHolesCounts& holes, const ManifoldCounts& manifold, Report& report);

/// Adds the boundary loops of a mesh to the report's list. `origin` is the mesh's, in the frame.
void note_loops(const PolygonMesh& mesh, const BoundaryLoops& loops, bool completed, const Vec3& origin,
                const CloudFrame& frame, Report& report);

} // namespace hsdm
