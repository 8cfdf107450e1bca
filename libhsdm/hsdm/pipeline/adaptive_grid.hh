#pragma once
// The adaptive grid as a step of the pipeline, with its part of the report.

#include "hsdm/pipeline/method.hh"

#include <span>

namespace hsdm {

/// Simplifies the facets of one level (relative to the octree's origin) over the leaves of a balanced octree.
/// Vertex properties are means over the fine vertices that a vertex stands for, labels the majority's. The
/// error bound is kept at `points`, from which the error is measured: their positions as read, even if the
/// octree's points have been moved. The report gets the bound, how many points the fine mesh misses by more,
/// and the distance of the result from it. `known`, of the fine mesh before, is of the result then: the cells
/// save time, how often facets meet is counted anew.
PolygonMesh adaptive_grid(const MethodInput& input, std::span<const Vec3> points, const PolygonMesh& fine,
                          FacetKnowledge& known, Report& report);

/// Throws Error if a point was measured farther from the final mesh than the bound and the report had not
/// said so; the message gives lengths times `unit`.
void check_error_kept(const Report& report, double unit = 1);

} // namespace hsdm
