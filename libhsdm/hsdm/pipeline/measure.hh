#pragma once
// What a report says of facets: how they hang together and how far the points are from them.

#include "hsdm/pipeline/method.hh"

namespace hsdm {

/// The octree's points where the cloud has them, relative to its origin.
std::vector<Vec3> points_as_read(const PointCloud& cloud, const CloudFrame& frame, const Octree& octree);

/// Drops small components if asked to, and measures what is left. A bound is checked before: it is one for
/// the points of what is dropped too.
void drop_and_measure(std::span<const Vec3> points, const MethodInput& in, PolygonMesh& facets,
                      FacetKnowledge& known, Report& report);

} // namespace hsdm
