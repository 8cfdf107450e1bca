#pragma once
// The adaptive grid as a step of the pipeline, with its part of the report.

#include "hsdm/pipeline/method.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <span>

namespace hsdm {

/// The facets of one level, relative to the octree's origin, over the leaves of a balanced octree. Vertex
/// properties are means over the fine vertices that a vertex stands for, of labels the majority's. The bound
/// is kept at `points`, which are those that the error is measured from: where they were read, whatever the
/// octree's have been moved to. Notes in the report the bound, how many points the fine mesh misses by more,
/// and the distance of the result from it. `cells`, of the fine mesh, if they are known, save time.
PolygonMesh adaptive_grid(const MethodInput& input, std::span<const Vec3> points, const PolygonMesh& fine,
                          const FacetCells* cells, Report& report);

/// Throws Error if a point was measured farther from the final mesh than the bound and none was announced; it
/// gives lengths times `unit`.
void check_error_kept(const Report& report, double unit = 1);

} // namespace hsdm
