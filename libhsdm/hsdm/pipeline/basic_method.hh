#pragma once
// Phase 2 by the basic method, sections 3.2.1 and 3.2.2: graph, facets and holes from positions alone.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/phases.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// What a method works on: one level of a decomposed cloud.
struct MethodInput {
    const CloudFrame& frame; ///< of the octree's coordinates
    const PointCloud& cloud; ///< for its colours and scalars: the rest may have been freed
    const Octree& octree;
    const OctreeLevel& level;
    const ReconstructOptions& options;
    const Phases& phases;
};

/// Facets relative to the octree's origin, an oriented 2-manifold with the vertices' properties. Adds its
/// seconds (graph, facets) and what each stage rejected to the report. Throws Cancelled.
PolygonMesh basic_method(const MethodInput& input, Report& report);

/// Adds to the report's list, unless nothing was dropped. `discarded.first` lies in the frame.
void note_dropped(const std::string& what, const Discarded& discarded, const CloudFrame& frame,
                  Report& report);

} // namespace hsdm
