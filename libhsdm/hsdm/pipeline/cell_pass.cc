#include "hsdm/pipeline/cell_pass.hh"

#include "hsdm/normals/neighbors.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t most_far_cells = std::size_t{1} << 16; // each is read alone

} // namespace

void CellPass::add(const Octree& octree, const VoxelRange& range, int ghost) {
    const std::vector<double> reach = look(octree, range);
    // Neighbours are sought level by level, by voxels around: how far, hangs on what is known there, but not
    // for those within half of what is known. Where all that is known are fewer than are sought, others
    // follow.
    const double seen = ghost * cloud_.voxel_size() / 2;
    const bool are_few =
        octree.size() <= static_cast<std::size_t>(NeighborOptions().count) && octree.size() < points_;
    widest_ = std::max(widest_, ghost);
    for (std::size_t begin = 0, end; begin < octree.size(); begin = end) {
        const MortonCode cell = cell_of(octree, begin);
        bool is_far = are_few;
        for (end = begin; end < octree.size() && cell_of(octree, end) == cell; ++end)
            is_far = is_far || reach[end] > seen;
        if (!is_own(range, cell)) continue;
        if (is_far)
            far_cells_.push_back(cell);
        else
            take(octree, begin, end);
    }
}

void CellPass::put_off(const std::vector<MortonCode>& cells, int ghost) {
    far_cells_.insert(far_cells_.end(), cells.begin(), cells.end());
    widest_ = std::max(widest_, ghost);
}

void CellPass::add_far_cells(ScratchCloud& cloud) {
    if (cloud.ranks().sum(far_cells_.size()) > most_far_cells)
        refuse_in_tiles("many points are far from their neighbours");
    const int shift = cloud.depth() - cloud.cell_depth();
    auto ghost =
        static_cast<int>(std::ranges::max(cloud.ranks().gather(static_cast<std::uint64_t>(widest_))));
    while (cloud.ranks().any(!far_cells_.empty())) {
        if ((ghost *= 2) > most_ghost_voxels) refuse_in_tiles("some points are far from all others");
        std::vector<VoxelRange> cells;
        for (const MortonCode cell : std::exchange(far_cells_, {}))
            cells.push_back({cell << 3 * shift, (cell + 1) << 3 * shift, cloud.depth(), shift});
        cloud.for_tiles(cells, ghost,
                        [&](const Octree& octree, const VoxelRange& cell) { add(octree, cell, ghost); });
    }
}

} // namespace hsdm
