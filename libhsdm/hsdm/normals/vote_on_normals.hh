#pragma once
// The last repair of estimated normals.

#include "hsdm/normals/estimate_normals.hh"

namespace hsdm {

/// For normals that are oriented: each point near a crease, or whose normal stands alone, takes the normal
/// that most of its neighbours on one plane with it agree on. Turns single points that were oriented wrongly.
/// O(n), parallel.
void vote_on_normals(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& estimate);

} // namespace hsdm
