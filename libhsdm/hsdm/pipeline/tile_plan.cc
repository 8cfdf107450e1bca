#include "hsdm/pipeline/tile_plan.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/octree/constants.hh"
#include "hsdm/octree/octree.hh"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace hsdm {
namespace {

/// The points of a range of cells and of those around, while it grows.
class TileSize {
public:
    TileSize(const std::unordered_map<MortonCode, std::size_t>& points, const TilePlanOptions& options)
        : points_(points), last_((1 << options.cell_depth) - 1) {
        const int side = 1 << (options.depth - options.cell_depth);
        reach_ = (options.ghost_voxels + side - 1) / side;
        share_ = std::min(1.0, static_cast<double>(options.ghost_voxels) / side);
    }

    double with(MortonCode cell) {
        double sum = sum_;
        for_new(cell, [&](MortonCode, std::size_t points, bool own) {
            sum += (own ? 1 : share_) * static_cast<double>(points);
        });
        return sum;
    }

    void add(MortonCode cell) {
        sum_ = with(cell);
        for_new(cell, [&](MortonCode code, std::size_t, bool own) { seen_[code] |= own ? 2 : 1; });
    }

private:
    /// act(code, points, own) for a cell and those around it, as far as they are not counted that way yet.
    template <class Act>
    void for_new(MortonCode cell, const Act& act) const {
        const VoxelCoord at = morton_decode(cell);
        VoxelCoord c;
        for (c[2] = std::max(0, at[2] - reach_); c[2] <= std::min(last_, at[2] + reach_); ++c[2])
            for (c[1] = std::max(0, at[1] - reach_); c[1] <= std::min(last_, at[1] + reach_); ++c[1])
                for (c[0] = std::max(0, at[0] - reach_); c[0] <= std::min(last_, at[0] + reach_); ++c[0]) {
                    const MortonCode code = morton_encode(c);
                    const auto points = points_.find(code);
                    if (points == points_.end()) continue;
                    const auto seen = seen_.find(code);
                    const bool counted = seen != seen_.end();
                    if (code == cell)
                        act(code, points->second, true); // what was counted as around it is not much
                    else if (!counted)
                        act(code, points->second, false);
                }
    }

    const std::unordered_map<MortonCode, std::size_t>& points_;
    std::unordered_map<MortonCode, int> seen_;
    std::int32_t last_;
    int reach_;
    double share_, sum_ = 0;
};

} // namespace

int cell_depth_of(int depth) {
    return depth <= 8 ? std::max(0, depth - 3) : std::min(depth - 5, 6);
}

std::vector<VoxelRange> plan_tiles(std::span<const ScratchPoints::Cell> cells,
                                   const TilePlanOptions& options) {
    const int shift = options.depth - options.cell_depth;
    std::unordered_map<MortonCode, std::size_t> points;
    for (const ScratchPoints::Cell& cell : cells) points[cell.code] = cell.points;
    std::vector<MortonCode> begins{0};
    std::optional<TileSize> size(std::in_place, points, options);
    bool empty = true;
    for (const ScratchPoints::Cell& cell : cells) {
        Interruption::poll();
        const bool is_border = std::ranges::binary_search(options.borders, cell.code);
        if (!empty && (is_border || size->with(cell.code) > static_cast<double>(options.most_points))) {
            begins.push_back(cell.code << 3 * shift);
            size.emplace(points, options);
        }
        size->add(cell.code);
        empty = false;
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
