#pragma once
// Points that are of no surface: outliers between and around the surfaces.

#include "hsdm/core/constants.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"
#include "hsdm/octree/constants.hh"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace hsdm {

struct OutlierOptions {
    /// largest ratio of a point's reach to the median reach of its neighbours
    double most_stretch = distance_outliers::most_stretch;
    /// largest ratio of a point's reach to the median reach of the cloud
    double most_sparseness = distance_outliers::most_sparseness;
    /// From this ratio on a point is tested further: it is removed if its neighbours fill a volume, or lie on
    /// a plane that it is far from.
    double doubtful_stretch = distance_outliers::doubtful_stretch;
    double doubtful_sparseness = distance_outliers::doubtful_sparseness;
    /// deviation of the neighbours from their plane, in reaches, from which on they fill a volume
    double least_volume = distance_outliers::least_volume;
    /// distance from the neighbours' plane, in reaches, from which on a point is off it; more than three of
    /// their deviations as well
    double least_height = distance_outliers::least_height;
    /// rounds: when some outliers are gone, others stand out more
    int rounds = repeats::few;
};

/// Removes points that are far from their neighbours while these are near each other, or far from all; less
/// far ones only if their neighbours do not lie beside them on a plane. The reach of a point is the distance
/// of its farthest neighbour; along a sampled surface it changes slowly, as does the plane, however sparse
/// the sampling. Returns how many, and where in the coordinates of the octree's bounds; `neighbors` becomes
/// that of the points left. O(n) per round, parallel.
Occurrences drop_outliers_by_distance(Octree& octree, Neighbors& neighbors,
                                      const OutlierOptions& options = {});

/// What the last function knows of all points, for one that looks at part of them.
struct ReachOfAll {
    double typical = 0;       ///< the median
    bool fill_volume = false; ///< do the neighbours of most points, by a sample?
};
/// One of so many points is in that sample, in octree order.
std::size_t volume_stride(std::size_t points);
bool fills_volume(const Octree& octree, const Neighbors& neighbors, std::size_t point,
                  const OutlierOptions& options = {});
/// Per point, 1 if a round of drop_outliers_by_distance() removes it.
std::vector<std::uint8_t> outliers_by_distance(const Octree& octree, const Neighbors& neighbors,
                                               const ReachOfAll& all, const OutlierOptions& options = {});

struct NormalOutlierOptions {
    /// points in a typical point's voxel on the level where sparse voxels are looked for
    double points_per_voxel = spacings::points_per_voxel;
    /// share of those points that a sparse voxel holds at most
    double most_share = normal_outliers::most_share;
    /// neighbours per point of a sparse voxel, [3, 64]
    int neighbors = neighborhoods::neighbors;
    /// so many of them must continue the point's own plane
    int least_support = points_of_plane;
    /// in voxels: largest distance of those that do and are not in a sparse voxel themselves
    double most_distance = normal_outliers::most_distance;
    /// radians: largest angle between normals of one plane (45 degrees)
    double most_angle = normal_outliers::most_angle;
    /// largest height of a neighbour over the point's plane, in distances between the two
    double most_rise = angles::half_of_sheet;
};

/// The level on which sparse voxels are looked for.
struct SparseLevel {
    int depth = 0;
    double typical = 0; ///< how many points share a typical point's voxel
};
/// The finest level on which a typical point of `points` shares its voxel with `points_per_voxel`. `voxels`:
/// how many there are of each level; squares_at(depth): the sum of the squares of their numbers of points.
SparseLevel sparse_level(std::size_t points, const std::array<std::size_t, morton_levels + 1>& voxels,
                         const std::function<double(int)>& squares_at, double points_per_voxel);

/// Per point, 1 if it is one of those that the next function removes; `reach`, unless it is null, becomes per
/// such point or one that was asked about the distance of the farthest neighbour, else 0. `finest_level`: as
/// in NeighborOptions.
std::vector<std::uint8_t> strays_by_normals(const Octree& octree, const SparseLevel& level,
                                            const NormalOutlierOptions& options = {},
                                            std::vector<double>* reach = nullptr,
                                            std::optional<int> finest_level = {});

/// The same if normals are known: removes those points in sparse voxels that too few neighbours agree with.
/// O(n), parallel; little more than one pass over the points if hardly any voxel is sparse. Throws
/// OptionError.
Occurrences drop_outliers_by_normals(Octree& octree, const NormalOutlierOptions& options = {});

} // namespace hsdm
