#include "hsdm/pipeline/tile_plan.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/morton_index.hh"
#include "hsdm/octree/constants.hh"
#include "hsdm/octree/octree.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// The points of a range of cells and of those around, while it grows.
class TileSize {
public:
    TileSize(std::span<const ScratchPoints::Cell> cells, const TilePlanOptions& options)
        : cells_(cells), counted_(cells.size(), 0), last_((1 << options.cell_depth) - 1) {
        const int side = 1 << (options.depth - options.cell_depth);
        reach_ = (options.ghost_voxels + side - 1) / side;
        share_ = std::min(1.0, static_cast<double>(options.ghost_voxels) / side);
        std::vector<MortonCode> codes;
        for (const ScratchPoints::Cell& cell : cells) codes.push_back(cell.code);
        place_.build(codes);
    }

    void begin_range() { ++range_, sum_ = 0; }

    /// The sum with this cell, which add() adds.
    double with(std::size_t cell) {
        cell_ = cell;
        new_.clear();
        with_ = sum_ + (is_counted(cell) ? 1 - share_ : 1) * points(cell);
        for_new([&](Index around) {
            with_ += share_ * points(around);
            new_.push_back(around);
        });
        return with_;
    }

    void add() {
        sum_ = with_;
        for (const Index around : new_) counted_[around] = range_;
        counted_[cell_] = range_;
    }

private:
    double points(std::size_t cell) const { return static_cast<double>(cells_[cell].points); }
    bool is_counted(std::size_t cell) const { return counted_[cell] == range_; }

    /// act(around) for the cells around it, as far as they are not counted yet.
    template <class Act>
    void for_new(const Act& act) const {
        const VoxelCoord at = morton_decode(cells_[cell_].code);
        VoxelCoord c;
        for (c[2] = std::max(0, at[2] - reach_); c[2] <= std::min(last_, at[2] + reach_); ++c[2])
            for (c[1] = std::max(0, at[1] - reach_); c[1] <= std::min(last_, at[1] + reach_); ++c[1])
                for (c[0] = std::max(0, at[0] - reach_); c[0] <= std::min(last_, at[0] + reach_); ++c[0])
                    if (const Index around = place_.find(morton_encode(c));
                        around != no_index && around != cell_ && !is_counted(around))
                        act(around);
    }

    std::span<const ScratchPoints::Cell> cells_;
    MortonIndex place_;
    std::vector<std::size_t> counted_; // the last range that has each cell, or has it around it
    std::size_t range_ = 0;
    std::int32_t last_;
    int reach_;
    double share_, sum_ = 0; // of a cell's points, where it is around
    std::size_t cell_ = 0;
    double with_ = 0;
    std::vector<Index> new_;
};

} // namespace

int cell_depth_of(int depth) {
    return depth <= 8 ? std::max(0, depth - 3) : std::min(depth - 5, 6);
}

std::vector<VoxelRange> plan_tiles(std::span<const ScratchPoints::Cell> cells,
                                   const TilePlanOptions& options) {
    const int shift = options.depth - options.cell_depth;
    std::vector<MortonCode> begins{0};
    TileSize size(cells, options);
    size.begin_range();
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        Interruption::poll();
        const bool is_border = std::ranges::binary_search(options.borders, cells[cell].code);
        const bool is_large = size.with(cell) > static_cast<double>(options.most_points);
        if (cell > 0 && (is_border || is_large)) {
            begins.push_back(cells[cell].code << 3 * shift);
            size.begin_range();
            size.with(cell);
        }
        size.add();
    }
    begins.push_back(MortonCode{1} << 3 * options.depth);
    std::vector<VoxelRange> ranges;
    for (std::size_t k = 0; k + 1 < begins.size(); ++k)
        ranges.push_back({begins[k], begins[k + 1], options.depth, shift});
    return ranges;
}

bool spans_no_surface(std::span<const Vec3> places, double cube_extent) {
    constexpr std::size_t fewest = 16;
    constexpr double negligible = 1e-6;
    if (places.size() < fewest) return true;
    const auto far_from_first = [&](const Vec3& p) { return (p - places[0]).sqrnorm(); };
    const Vec3 along = (std::ranges::max(places, {}, far_from_first) - places[0]).normalized();
    return std::ranges::all_of(places, [&](const Vec3& p) {
        return !(((p - places[0]) % along).norm() > negligible * cube_extent);
    });
}

bool has_far_points(std::span<const Vec3> places, double cube_extent, double spacing) {
    if (spacings::spacings_per_voxel * spacing < cube_extent / (1 << deepest_level)) return true;
    double extent = 0;
    std::vector<double> values(places.size());
    for (unsigned axis = 0; axis < 3; ++axis) {
        std::ranges::transform(places, values.begin(), [&](const Vec3& p) { return p[axis]; });
        std::ranges::sort(values);
        const std::size_t outer = std::max<std::size_t>(1, values.size() / far_points::one_outer_in);
        if (2 * outer >= values.size()) return false;
        extent = std::max(extent, values[values.size() - 1 - outer] - values[outer]);
    }
    constexpr double near = 0.99; // a little less, for rounding
    return extent > 0 && far_points::boxes_across * near * extent < cube_extent;
}

} // namespace hsdm
