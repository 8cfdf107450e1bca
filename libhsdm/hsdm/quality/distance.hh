#pragma once
// Section 4: how far the points are from the mesh, exactly.

#include "hsdm/polygon_mesh.hh"

#include <limits>
#include <span>

namespace hsdm {

/// One-sided distance of a set of points to a surface, in the cloud's units.
struct Distance {
    double max = 0;               ///< one-sided Hausdorff distance
    double mean = 0;              ///< mean distance
    double rms = 0;               ///< root of the mean square
    std::size_t farthest = 0;     ///< index of the point at distance max
    std::size_t beyond = 0;       ///< how many points lie farther than was asked
    std::size_t first_beyond = 0; ///< index of the first of them, if there is one
};

/// What has to be found out about the distances of many points.
struct DistanceOptions {
    /// Distances up to this may come out larger, but not above it: to know that a bound is kept is several
    /// times faster than to know by how much.
    double enough = 0;
    double beyond = std::numeric_limits<double>::infinity(); ///< >= enough: farther points are counted
};

/// Every point against its nearest triangle, through the tree; parallel, quickest when neighbours in the list
/// are neighbours in space, the same bits for any thread count. Zero for an empty list.
Distance points_to_mesh(std::span<const Vec3> points, const PolygonMesh& mesh,
                        const DistanceOptions& options = {});

/// Points spread evenly over the mesh's area, deterministic: for the other direction of a Hausdorff distance.
std::vector<Vec3> sample_surface(const PolygonMesh& mesh, std::size_t count);

} // namespace hsdm
