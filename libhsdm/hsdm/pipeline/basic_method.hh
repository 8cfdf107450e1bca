#pragma once
// Phase 2 by the basic method, sections 3.2.1 and 3.2.2: graph, facets and holes from positions alone.

#include "hsdm/pipeline/method.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Facets relative to the octree's origin, an oriented 2-manifold with the vertices' properties. Adds its
/// seconds (graph, facets) and what each stage rejected to the report. Throws Cancelled.
PolygonMesh basic_method(const MethodInput& input, Report& report);

} // namespace hsdm
