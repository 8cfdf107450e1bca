#pragma once
// Points far from all others.

#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct OutlierOptions {
    double most_stretch = 4;     ///< of a point's reach against the median reach of its neighbours
    double most_sparseness = 10; ///< of a point's reach against the median of the cloud
};

/// Removes the points that are far from their neighbours while these are near each other, or far from all:
/// strays around a surface. The reach of a point is the distance of the farthest of its neighbours, which
/// changes slowly along a sampled surface. Returns how many; the neighbours are out of date if that is not 0.
/// O(n), parallel.
std::size_t drop_outliers(Octree& octree, const Neighbors& neighbors, const OutlierOptions& options = {});

} // namespace hsdm
