#pragma once
// How far the points show the surface, per vertex.

#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/method.hh"

namespace hsdm {

inline constexpr const char* confidence_property = "hsdm_confidence";

/// Per vertex, the share of the surface within a voxel's edge that points show: measured points (those with a
/// `source`) that near whose normals lie within 60 degrees of the vertex's, over those that a flat surface of
/// this spacing has there; at most 1. 0 where all is completed, about a half at a border. `turned` says that
/// the facets face against the points' normals. O(points near vertices), parallel.
std::vector<double> vertex_confidence(const Octree& octree, const OctreeLevel& level, const PolygonMesh& mesh,
                                      double spacing, bool turned = false);

/// Drops the facets whose vertices have less confidence than this, in the mean; notes how many, and where.
void trim_by_confidence(double least, const MethodInput& in, PolygonMesh& facets, FacetKnowledge& known,
                        Report& report);

} // namespace hsdm
