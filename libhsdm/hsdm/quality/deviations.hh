#pragma once
// On which side of a mesh points lie, and how far: the map of an inspection report.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// Signed distances in the units of points and mesh, positive on the side that facets' normals point to: for
/// a closed mesh, outside.
struct Deviations {
    std::vector<double> of_points; ///< one per point: its magnitude is the exact distance; NaN if not finite
    /// One per vertex: the mean over the points nearest to a triangle of the vertex, weighted by their feet's
    /// barycentric coordinates; NaN where there is no such point.
    std::vector<double> at_vertices;
};

/// Every point against its nearest triangle, of a mesh cut as the STL writer cuts it. Beside an edge or a
/// corner the side is that of the mean normal of the triangles there, weighted by their angles, which is
/// right for any 2-manifold (Baerentzen and Aanaes 2005). O(points log triangles), parallel, the same bits
/// for any number of threads. Throws Error for a mesh without facets.
Deviations measure_deviations(std::span<const Vec3> points, const PolygonMesh& mesh);

} // namespace hsdm
