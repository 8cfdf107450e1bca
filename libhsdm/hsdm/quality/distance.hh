#pragma once
// Section 4: how far the points are from the mesh, exactly.

#include "hsdm/polygon_mesh.hh"

#include <limits>
#include <span>

namespace hsdm {

/// One-sided distance of a set of points to a surface, in the cloud's units.
struct Distance {
    double max = 0; ///< one-sided Hausdorff distance
    double mean = 0;
    double rms = 0;
    std::size_t farthest = 0;     ///< index of the point at distance max
    std::size_t beyond = 0;       ///< how many points lie farther than was asked
    std::size_t first_beyond = 0; ///< index of the first of them, if there is one
};

/// What is to be known of the distances of many points.
struct DistanceOptions {
    double enough = 0; ///< distances up to it may come out larger, though never above it: whether a bound is
                       ///< kept is known several times sooner than by how much
    double beyond = std::numeric_limits<double>::infinity(); ///< >= enough: farther points are counted
};

class FacetCells;
class MeshDistance;
class SurfaceWalk;

/// Every point against its nearest triangle by walks and searches, parallel, the same bits for any thread
/// count: for points that lie close to the surface.
Distance points_to_surface(std::span<const Vec3> points, const SurfaceWalk& surface,
                           const DistanceOptions& options = {});

/// Every point against its nearest triangle, through the tree; parallel, quickest when neighbours in the list
/// are neighbours in space, the same bits for any thread count. Zero for an empty list.
Distance points_to_mesh(std::span<const Vec3> points, const MeshDistance& mesh,
                        double beyond = std::numeric_limits<double>::infinity());
/// The same of a mesh that is not asked again.
Distance points_to_mesh(std::span<const Vec3> points, const PolygonMesh& mesh,
                        const DistanceOptions& options = {});

/// The same by the cells of the mesh: in half the time where facets are about as large as cells and the
/// points of a cell follow each other in the list, as in a mesh of a uniform octree level and its voxels; by
/// the tree where cells are not usable. Distances may differ from those of the tree by rounding.
Distance points_to_mesh_by_cells(std::span<const Vec3> points, const PolygonMesh& mesh,
                                 const FacetCells& cells,
                                 double beyond = std::numeric_limits<double>::infinity());

/// Points spread evenly over the mesh's area, deterministic: for the other direction of a Hausdorff distance.
std::vector<Vec3> sample_surface(const PolygonMesh& mesh, std::size_t count);

} // namespace hsdm
