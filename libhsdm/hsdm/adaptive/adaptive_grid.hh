#pragma once
// The adaptive grid as a step of the pipeline, with its part of the report.

#include "hsdm/basic_method.hh"

namespace hsdm {

/// Does the caller want an adaptive grid?
bool wants_adaptive(const ReconstructOptions& options);

/// The facets of one level, relative to the octree's origin, over the leaves of a balanced octree; vertex
/// properties are those of the fine vertices nearest. Throws Error if points that the fine mesh is near to
/// end up farther from the result than the bound.
PolygonMesh adaptive_grid(const MethodInput& input, const PolygonMesh& fine, Report& report);

} // namespace hsdm
