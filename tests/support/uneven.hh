#pragma once
// Clouds whose density falls across the part, as that of a scanner that stands near one end of it.

#include "hsdm/point_cloud.hh"

namespace hsdm::support {

/// A scanner on the side of the cloud that `side` points to, so near that a surface at its far end has
/// `ratio` (above 1) times fewer points to its area than one at its near end: the root of that is how many
/// times as far away it is.
Vec3 scanner_beside(const PointCloud& cloud, const Vec3& side, double ratio);

/// Those points of an even cloud that are left if a surface has as many as its distance from the scanner,
/// squared, allows; the nearest keep all. The same seed leaves the same points.
PointCloud thinned_by_distance(const PointCloud& cloud, const Vec3& scanner, std::uint64_t seed = 1);

/// All points of the `share` of an even cloud's that lie farthest to `side`, and of the others one in
/// `ratio`, by chance.
PointCloud thinned_on_one_side(const PointCloud& cloud, const Vec3& side, double share, double ratio,
                               std::uint64_t seed = 1);

} // namespace hsdm::support
