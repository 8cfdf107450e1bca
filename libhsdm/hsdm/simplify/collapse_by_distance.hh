#pragma once
// Vertices that a surface does without, by measured distances.

#include "hsdm/simplify/collapsing_mesh.hh"
#include "hsdm/simplify/content_keys.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <span>

namespace hsdm {

/// A vertex to be taken out by collapsing an edge onto another.
struct DistanceCollapse {
    Index side; ///< of the triangles that the mesh is cut into
    Index vertex, onto;
    Key ring; ///< of the vertices round it by then
};

/// Which inner vertices can go where the surface is smooth, each with its shortest edge that may collapse,
/// those with the shortest first: where it is looked at (along new edges and in the middles of triangles)
/// what replaces their facets is no farther than the tolerance from the fine surface, nor is the vertex from
/// that. Planes of vertices, by which collapse_by_planes() goes, refuse a strip of a cylinder that ends
/// between the vertices of its rims; this takes it. At most 32 sweeps, O(n) each, of fewer vertices;
/// parallel, the same for any number of threads.
std::vector<DistanceCollapse> find_distance_collapses(CollapsingMesh mesh, const SurfaceWalk& fine,
                                                      double tolerance);

/// Takes vertices out of the mesh that they were found for, in that order, but for those, `may_go` being 0,
/// that are to stay, which no vertex gives way to either, and for those whose facets are then other ones.
/// O(n).
CollapsedMesh collapse_by_distance(CollapsingMesh mesh, std::span<const DistanceCollapse> drops,
                                   const std::vector<std::uint8_t>& may_go);

} // namespace hsdm
