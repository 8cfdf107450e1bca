#pragma once
// Facets -> the mesh of a reconstruction: what is unsound left out, measured, outward, with its features.

#include "hsdm/pipeline/method.hh"

#include <functional>

namespace hsdm {

/// Throws Error if there are none.
void check_facets(const PolygonMesh& facets, const Report& report);

/// Converts mesh and report from the stages' coordinates and units back to the cloud's.
void tell_in_cloud_units(const CloudFrame& frame, PolyMesh& mesh, Report& report);

/// Phase 3 and what it needs. Of `in`, no points are read. `measure` is called once, in the phase "error": it
/// may drop facets. Throws Error if no facet is left, Cancelled.
void finish_mesh(const MethodInput& in, PolygonMesh&& facets, FacetKnowledge&& known, Report&& report,
                 Reconstruction& result,
                 const std::function<void(PolygonMesh&, FacetKnowledge&, Report&)>& measure);

} // namespace hsdm
