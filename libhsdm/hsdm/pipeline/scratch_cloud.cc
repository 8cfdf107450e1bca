#include "hsdm/pipeline/scratch_cloud.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Not more than this, for what waits in many small vectors is not of use to large ones once it is freed.
std::size_t bytes_buffered(const TileOptions& options) {
    return std::clamp(options.memory / 16, std::size_t{1} << 20, std::size_t{1} << 26);
}

} // namespace

void refuse_in_tiles(const std::string& what) {
    throw Error(what + "; this is not done in tiles, reconstruct it in one piece (without --memory)");
}

CloudExtent measure_extent(const PointParts& parts) {
    CloudExtent extent;
    parts([&](const PointView& part) {
        check_view(part);
        if (!part.has_normals())
            refuse_in_tiles("the cloud has no normals, which would have to be estimated");
        if (part.colors.count > 0 || !part.scalars.empty())
            refuse_in_tiles("the cloud has colours or scalars");
        const NonfiniteRows nonfinite = find_nonfinite(part.positions);
        if (nonfinite.count > 0 && extent.nonfinite == 0)
            extent.first_nonfinite = extent.points + nonfinite.first;
        extent.nonfinite += nonfinite.count;
        extent.points += part.size();
        extent.box.add(finite_bounds(part.positions));
    });
    if (extent.points == 0) throw Error("the cloud holds no point; nothing can be reconstructed");
    if (extent.points >= no_index) refuse_in_tiles("the cloud holds 2^32 points or more");
    if (2 * extent.nonfinite > extent.points)
        throw Error(std::to_string(extent.nonfinite) + " of " + std::to_string(extent.points)
                    + " points have coordinates that are not finite; check how the file was exported");
    const Vec3 zero(0, 0, 0); // -0 becomes 0, as in the octree
    extent.box = {extent.box.lo + zero, extent.box.hi + zero};
    if (CloudFrame(extent.box).unit() != 1) refuse_in_tiles("the cloud is of extreme size");
    if (!has_voxels(extent.box)) throw Error("all points are equal; a surface needs points that differ");
    return extent;
}

ScratchCloud::ScratchCloud(const PointParts& parts, const CloudExtent& extent, int depth,
                           const TileOptions& options)
    : extent_(extent),
      frame_(extent.box),
      depth_(depth),
      cell_depth_(cell_depth_of(depth)),
      scratch_(options.scratch, extent.finite(), bytes_buffered(options)) {
    options_.placement = CubePlacement::centred;
    options_.whole = extent.box;
    none_.extent = extent.box.extent();
    none_.origin = centred_origin(extent.box, none_.extent);
    none_.bounds = extent.box;
    std::size_t added = 0;
    parts([&](const PointView& part) {
        for_each_in_order(part.size(), [&](std::size_t i) {
            const Vec3 p = vec3_at(part.positions, i), n = vec3_at(part.normals, i);
            if (!is_finite(p)) return;
            const MortonCode code = code_at(p - origin(), cube_extent());
            scratch_.add(code >> 3 * (morton_levels - cell_depth_), {p[0], p[1], p[2], n[0], n[1], n[2]});
            ++added;
        });
    });
    scratch_.finish();
    if (added != extent.finite())
        throw Error("the points have changed while they were read; read them again");
    cells_ = scratch_.cells();
}

OctreeLevel ScratchCloud::no_voxels() const {
    OctreeLevel level;
    level.depth = depth_;
    level.voxel_size = voxel_size();
    return level;
}

Octree ScratchCloud::octree_of(const std::vector<PointRow>& rows) const {
    PointView view;
    view.positions = StridedSpan(rows.front().data(), rows.size(), sizeof(PointRow));
    view.normals = StridedSpan(rows.front().data() + 3, rows.size(), sizeof(PointRow));
    Octree octree = build_octree(view, options_);
    if (!left_out_.empty()) {
        std::vector<std::uint8_t> marks = large_vector<std::uint8_t>(octree.size(), 0);
        for_each_index(octree.size(), chunks::usual,
                       [&](Index i) { marks[i] = std::ranges::binary_search(left_out_, row_at(octree, i)); });
        remove_points(octree, marks);
    }
    return octree;
}

std::vector<PointRow> ScratchCloud::rows_of(const VoxelRange& range, int ghost) const {
    std::vector<PointRow> rows, cell;
    const int shift = 3 * (depth_ - cell_depth_), to_level = 3 * (morton_levels - depth_);
    const int cells_around = (ghost >> (depth_ - cell_depth_)) + 1;
    VoxelRange of_cells{range.begin >> shift, range.end >> shift, cell_depth_, 0};
    for (const ScratchPoints::Cell& c : cells_) {
        if (of_cells.holds(c.code)) {
            scratch_.read(c.code, rows);
            continue;
        }
        if (!of_cells.is_near(morton_decode(c.code), cells_around)) continue;
        Interruption::poll();
        cell.clear();
        scratch_.read(c.code, cell);
        for (const PointRow& row : cell) {
            const MortonCode code = code_at(Vec3(row[0], row[1], row[2]) - origin(), cube_extent());
            if (range.is_near(morton_decode(code >> to_level), ghost)) rows.push_back(row);
        }
    }
    return rows;
}

void ScratchCloud::for_groups(std::size_t most, const std::function<void(const Octree&)>& visit) const {
    std::vector<PointRow> rows;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        scratch_.read(cells_[c].code, rows);
        if (c + 1 < cells_.size() && rows.size() + cells_[c + 1].points <= most) continue;
        const Octree octree = octree_of(rows);
        rows = std::vector<PointRow>();
        visit(octree);
    }
}

void ScratchCloud::leave_out(std::vector<PointRow> rows) {
    left_out_ = std::move(rows);
    std::ranges::sort(left_out_);
}

PointRow ScratchCloud::row_at(const Octree& octree, std::size_t point) {
    const Vec3 &p = octree.positions[point], &n = octree.normals[point];
    return {p[0], p[1], p[2], n[0], n[1], n[2]};
}

} // namespace hsdm
