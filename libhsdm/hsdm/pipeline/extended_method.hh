#pragma once
// Phase 2 by the extended method, section 3.4.2: graph and facets from normal-consistent sets.

#include "hsdm/pipeline/method.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

inline constexpr const char* completed_property = "hsdm_completed"; ///< std::uint8_t, 1 where no point was

/// Facets relative to the octree's origin, an oriented 2-manifold with the vertices' properties. The octree
/// must have normals. Adds its seconds (graph, facets) and what each stage counted to the report. Fills in
/// those parts of `known` that it finds out. Throws Cancelled.
PolygonMesh extended_method(const MethodInput& input, Report& report, FacetKnowledge& known);

} // namespace hsdm
