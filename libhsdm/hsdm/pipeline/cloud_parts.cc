#include "hsdm/pipeline/cloud_parts.hh"

#include <algorithm>
#include <utility>

namespace hsdm {

CloudPart::CloudPart(const ScratchCloud& cloud, std::span<const Survey::FirstPoint> first,
                     const ScratchCloud::Surroundings& around, Octree octree, std::vector<MortonCode> missing)
    : around_(around),
      octree_(std::move(octree)),
      cell_depth_(cloud.cell_depth()),
      missing_(std::move(missing)) {
    const int shift = 3 * (morton_levels - cloud.depth());
    const auto first_of = [&](MortonCode code) {
        return static_cast<std::size_t>(std::ranges::lower_bound(octree_.codes, code << shift)
                                        - octree_.codes.begin());
    };
    begin_ = first_of(range().begin), end_ = first_of(range().end);
    const int to_cell = 3 * (morton_levels - cell_depth_);
    for (std::size_t i = 0; i < octree_.size(); ++i) {
        const MortonCode cell = octree_.codes[i] >> to_cell;
        if (!cells_.empty() && cells_.back().code == cell) continue;
        const auto whole = std::ranges::lower_bound(first, cell, {}, &Survey::FirstPoint::cell);
        cells_.push_back({cell, i, whole->number});
    }
}

/// Few cells are looked up; where there would be more, the missing ones are looked through.
bool CloudPart::has(const VoxelCoord& lo, const VoxelCoord& hi, int level) const {
    constexpr std::int64_t few = 64;
    const std::int32_t last = (std::int32_t{1} << cell_depth_) - 1;
    VoxelCoord from, to;
    std::int64_t count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const int down = level - cell_depth_;
        from[k] = std::clamp(down >= 0 ? lo[k] >> down : lo[k] * (1 << -down), 0, last);
        to[k] = std::clamp(down >= 0 ? hi[k] >> down : (hi[k] + 1) * (1 << -down) - 1, 0, last);
        count *= to[k] - from[k] + 1;
    }
    if (count > few)
        return std::ranges::none_of(missing_, [&](MortonCode code) {
            const VoxelCoord c = morton_decode(code);
            return c[0] >= from[0] && c[0] <= to[0] && c[1] >= from[1] && c[1] <= to[1] && c[2] >= from[2]
                   && c[2] <= to[2];
        });
    VoxelCoord c;
    for (c[2] = from[2]; c[2] <= to[2]; ++c[2])
        for (c[1] = from[1]; c[1] <= to[1]; ++c[1])
            for (c[0] = from[0]; c[0] <= to[0]; ++c[0])
                if (std::ranges::binary_search(missing_, morton_encode(c))) return false;
    return true;
}

bool CloudPart::has_around(const VoxelCoord& voxel, int level, int reach) const {
    VoxelCoord lo = voxel, hi = voxel;
    for (std::size_t k = 0; k < 3; ++k) lo[k] -= reach, hi[k] += reach;
    return is_whole() || has(lo, hi, level);
}

Index CloudPart::number(std::size_t point) const {
    const auto after = std::ranges::upper_bound(cells_, point, {}, &Cell::first);
    const Cell& cell = *(after - 1);
    return static_cast<Index>(cell.number + (point - cell.first));
}

int PartWidths::ghost_of(const VoxelRange& range, const ScratchCloud& cloud) {
    if (std::exchange(version_, cloud.version()) != cloud.version()) ghost_.clear();
    const auto found = ghost_.find({range.begin, range.end});
    return found != ghost_.end() ? found->second : std::max(first_, cloud.cell_side());
}

void for_parts(ScratchCloud& cloud, const Survey& sums, std::span<const VoxelRange> ranges,
               PartWidths& widths, const std::function<bool(const CloudPart&)>& work) {
    constexpr int most_cells = 32; // round a part, at any depth; up to 64 lie along the cube
    const std::vector<Survey::FirstPoint> first = sums.first_points();
    std::vector<ScratchCloud::Surroundings> due;
    for (const VoxelRange& range : ranges)
        if (cloud.owner_of(range) == cloud.ranks().rank())
            due.push_back({range, widths.ghost_of(range, cloud)});
    while (cloud.ranks().any(!due.empty())) {
        cloud.fetch(due);
        std::vector<ScratchCloud::Surroundings> again;
        for (const auto& [range, ghost] : due) {
            std::vector<MortonCode> missing;
            Octree octree = cloud.octree_of_cells(range, ghost, missing);
            const CloudPart part(cloud, first, {range, ghost}, std::move(octree), std::move(missing));
            if (part.begin() == part.end()) continue;
            widths.note(range, ghost);
            if (work(part)) continue;
            const int widest = most_cells * cloud.cell_side();
            if (ghost >= widest) refuse_in_tiles("what some points depend on is farther off than tiles see");
            again.push_back({range, std::min(2 * ghost, widest)});
        }
        due = std::move(again);
    }
}

} // namespace hsdm
