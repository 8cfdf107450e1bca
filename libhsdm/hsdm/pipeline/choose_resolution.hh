#pragma once
// The voxels that the options ask for, or that spacing and noise of the points suggest.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/reconstruct.hh"

#include <functional>

namespace hsdm {

/// A cube of 2^depth voxels along an edge.
struct VoxelCube {
    double extent = 0;
    int depth = 1; ///< [1, 16]
};

/// The smallest cube of voxels of this size that holds a cloud whose box is so long. The size is in multiples
/// of `unit` of the cloud's. Throws OptionError for one that is too large or too small for that cloud.
VoxelCube cube_of_voxels(double voxel_size, double cloud_extent, double unit);

/// What asks for finer voxels than the spacing.
struct Detail {
    bool cylinders = false; ///< are bores or rods under two voxels wide more than a detail?
    bool bends = false;     ///< do facets of the voxels cut off more than noise leaves?
};

/// What has the points, in memory or elsewhere.
struct PlacedPoints {
    const Octree& octree; ///< its box and its cube as they are at the time; the points may be missing
    const CloudFrame& frame;
    double noise = 0; ///< standard deviation, if it is large
    /// Puts the points in a cube about their box.
    std::function<void(const VoxelCube&)> rearrange;
    std::function<Detail(int)> detail; ///< of the voxels of a depth
};

/// Chooses the depth, in a cube that fits; enters in the report (which has the spacing) what it was chosen
/// by. Throws OptionError.
int choose_resolution(const ReconstructOptions& options, const PlacedPoints& points, Report& report);

} // namespace hsdm
