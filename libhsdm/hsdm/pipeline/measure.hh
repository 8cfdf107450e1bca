#pragma once
// The report's part on facets: their topology and how far the points are from them.

#include "hsdm/pipeline/method.hh"

namespace hsdm {

/// The octree's points at the positions that they have in the cloud, relative to its origin.
std::vector<Vec3> points_as_read(const PointCloud& cloud, const CloudFrame& frame, const Octree& octree);

/// Drops small components if asked to, and measures the rest. An error bound is checked before, because it
/// covers the points of dropped components too.
void drop_and_measure(std::span<const Vec3> points, const MethodInput& in, PolygonMesh& facets,
                      FacetKnowledge& known, Report& report);

} // namespace hsdm
