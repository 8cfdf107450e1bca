#pragma once
// Outliers: sets of a few points that no neighbour continues.

#include "hsdm/contour/set_relation.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/normals/constants.hh"

namespace hsdm {

struct OutlierSetOptions {
    /// An outlier set has at most this share of the points of a typical set, or a single point.
    double most_share = normal_outliers::most_share;
    /// At most so many outlier sets are connected by smooth relations from voxel to voxel; more are a
    /// surface.
    std::size_t most_sets = stray_sets::most_sets;
    /// Points in a set, the mean over points, of the whole cloud that these sets are a part of; 0: of these.
    double typical = 0;
};

/// Points in a set, the mean over points rather than sets, so that full voxels count more than clipped ones:
/// `squares` over `points`, which of parts of a cloud can be added up.
struct SetSizes {
    double points = 0, squares = 0; ///< whole numbers: in any order the same
    double typical() const { return points > 0 ? squares / points : 0; }
};
SetSizes sizes_of(const NormalSets& sets);

/// Removes the outlier sets; their points belong to no set afterwards. A set of few points is an outlier if
/// smooth relations to sets of the 26 voxels around, and on from there, reach neither a set of more points
/// nor more than a few others: a surface covers more voxels or holds more points. Returns the number of
/// points, and where they are relative to the octree's origin. O(sets), parallel.
Occurrences drop_outlier_sets(const OctreeLevel& level, const RelationTest& related, NormalSets& sets,
                              const OutlierSetOptions& options = {});

} // namespace hsdm
