#pragma once
// Sparse areas of a cloud on disk.

#include "hsdm/pipeline/cloud_noise.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// As levels_above_sparse() of the whole. For all ranks at the same time.
int levels_above_sparse(const ScratchCloud& cloud, std::size_t most_points);

/// A voxel, so many levels above the finest as help out, with a point that `levels` of them are too fine for.
struct SparseVoxel {
    MortonCode code;
    int levels;
};
/// Those of all ranks, for all of them at the same time.
std::vector<SparseVoxel> sparse_voxels(ScratchCloud& cloud, int levels, const CloudPasses& passes);

/// As SparseAreas::points_between() of the whole with so many coarser levels: points on the facets that the
/// first rank has, in the cloud's cube. For all ranks at the same time.
ScratchCloud points_between(ScratchCloud& cloud, const PolygonMesh& facets, int levels, int above,
                            const std::vector<SparseVoxel>& sparse, const CloudPasses& passes);

} // namespace hsdm
