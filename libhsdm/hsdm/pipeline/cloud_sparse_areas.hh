#pragma once
// Sparse areas of a cloud on disk.

#include "hsdm/pipeline/cloud_noise.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// As levels_above_sparse() of the whole. For all ranks at the same time.
int levels_above_sparse(const ScratchCloud& cloud, std::size_t most_points);

/// As SparseAreas::points_between() of the whole with so many coarser levels: points on the facets that the
/// first rank has, in the cloud's cube. For all ranks at the same time.
ScratchCloud points_between(ScratchCloud& cloud, const PolygonMesh& facets, int levels, int above,
                            const CloudPasses& passes);

} // namespace hsdm
