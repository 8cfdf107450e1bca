#pragma once
// Removes vertices by edge collapses under a bound on the measured distance.

#include "hsdm/simplify/collapsing_mesh.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <span>

namespace hsdm {

/// A vertex to be removed by collapsing an edge onto another vertex.
struct DistanceCollapse {
    Index side; ///< half-edge of the triangles that the mesh is cut into
    Index vertex, onto;
    std::uint64_t ring; ///< hash of its neighbours at the time
};

/// Finds the inner vertices that can be removed where the surface is smooth, each by its shortest edge that
/// may collapse, shortest first. The facets that replace theirs must lie within the tolerance of the fine
/// surface at sample places (along new edges and in the middles of triangles), and the vertex within the
/// tolerance of those facets. The planes of vertices (collapse_by_planes) would keep strips of a cylinder
/// that end between the vertices of its rims; distances do not. At most 32 sweeps, O(n) each, of ever fewer
/// vertices; parallel, the same for any number of threads.
std::vector<DistanceCollapse> find_distance_collapses(CollapsingMesh mesh, const SurfaceWalk& fine,
                                                      double tolerance);

/// Makes these collapses, in order, in the mesh that they were found for. Skips those from or onto a vertex
/// with `may_go` 0, and those whose vertex has other neighbours by then than when they were found. O(n).
CollapsedMesh collapse_by_distance(CollapsingMesh mesh, std::span<const DistanceCollapse> drops,
                                   const std::vector<std::uint8_t>& may_go);

} // namespace hsdm
