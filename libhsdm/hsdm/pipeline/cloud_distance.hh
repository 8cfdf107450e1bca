#pragma once
// How far the points of a cloud on disk are from facets.

#include "hsdm/core/occurrences.hh"
#include "hsdm/pipeline/scratch_cloud.hh"
#include "hsdm/polygon_mesh.hh"
#include "hsdm/quality/distance.hh"

namespace hsdm {

/// Distances of all points, at most so many at once, from facets relative to the cube; for facets about as
/// large as voxels, of which those round the points are looked at. `off`: points farther than a voxel's
/// diagonal, in the cloud's coordinates. The bits of measuring all at once, but for points that are farther
/// than a voxel, which may differ by rounding. The first rank calls it, with the facets, and at the same time
/// all others the next function: each measures its own points.
Distance cloud_distance(const ScratchCloud& cloud, const PolygonMesh& facets, std::size_t most_points,
                        Occurrences& off);

void assist_cloud_distance(const ScratchCloud& cloud, std::size_t most_points);

} // namespace hsdm
