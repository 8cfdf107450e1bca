#pragma once
// Outliers: sets of a few points that no neighbour continues.

#include "hsdm/contour/set_relation.hh"
#include "hsdm/core/discarded.hh"

namespace hsdm {

struct OutlierSetOptions {
    /// of the points of a typical set: an outlier set has no more, or just one point
    double most_share = stray_sets::most_share;
    /// that are smoothly related from voxel to voxel; more are a surface
    std::size_t most_sets = stray_sets::most_sets;
};

/// Removes the outliers from their voxels; their points belong to no set afterwards: sets of a few points
/// that reach, by smooth relations to sets of the 26 voxels around, neither a set of more points nor many
/// others. A surface covers more voxels or holds more points. Returns the number of points, and where
/// relative to the octree's origin. O(sets), parallel.
Discarded drop_outlier_sets(const OctreeLevel& level, const RelationTest& related, NormalSets& sets,
                            const OutlierSetOptions& options = {});

} // namespace hsdm
