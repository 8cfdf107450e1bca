#pragma once
// A whole cloud on disk, sorted by cells of its octree, and the parts of it that are looked at one at a time.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/io/scratch_points.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "hsdm/pipeline/voxel_range.hh"

namespace hsdm {

/// Throws Error of a cloud that can be reconstructed, but not in tiles.
[[noreturn]] void refuse_in_tiles(const std::string& what);

/// What a pass over the points finds.
struct CloudExtent {
    std::size_t points = 0, nonfinite = 0;
    std::size_t first_nonfinite = 0; ///< if there is one
    Box box;                         ///< of those that are finite

    std::size_t finite() const { return points - nonfinite; }
};

/// One pass over the points. Throws Error for what is no cloud, or none that is done in tiles.
CloudExtent measure_extent(const PointParts& parts);

/// The finite points of a cloud, on disk but for those left out.
class ScratchCloud {
public:
    /// One more pass over the points. `memory` and `scratch` of the options. Throws Error as ScratchPoints,
    /// and if there are other points than were measured.
    ScratchCloud(const PointParts& parts, const CloudExtent& extent, int depth, const TileOptions& options);

    const CloudExtent& extent() const { return extent_; }
    const CloudFrame& frame() const { return frame_; }
    const std::vector<ScratchPoints::Cell>& cells() const { return cells_; }
    int depth() const { return depth_; }
    int cell_depth() const { return cell_depth_; }
    double cube_extent() const { return none_.extent; }
    const Vec3& origin() const { return none_.origin; } ///< of the cube, in the cloud's coordinates
    double voxel_size() const { return none_.voxel_size(depth_); }
    std::size_t bytes() const { return scratch_.bytes(); } ///< on disk

    /// The octree of the whole without its points, and the level of all facets without its voxels.
    const Octree& no_points() const { return none_; }
    OctreeLevel no_voxels() const;

    Octree octree_of(const std::vector<PointRow>& rows) const;
    /// The points of a range and of `ghost` voxels around it.
    std::vector<PointRow> rows_of(const VoxelRange& range, int ghost) const;
    /// visit(octree) of all points, `most` or a cell's at a time, in Morton order.
    void for_groups(std::size_t most, const std::function<void(const Octree&)>& visit) const;

    /// Leaves points out from now on, as the octrees have them.
    void leave_out(std::vector<PointRow> rows);
    const std::vector<PointRow>& left_out() const { return left_out_; } ///< ascending
    static PointRow row_at(const Octree& octree, std::size_t point);

private:
    CloudExtent extent_;
    CloudFrame frame_;
    OctreeOptions options_;
    Octree none_;
    int depth_, cell_depth_;
    ScratchPoints scratch_;
    std::vector<ScratchPoints::Cell> cells_;
    std::vector<PointRow> left_out_;
};

} // namespace hsdm
