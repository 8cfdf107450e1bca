#pragma once
// A pass over the points of a cloud on disk that looks at the neighbours of each.

#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// Takes points cell by cell, in no order of cells, once all neighbours of a cell's points are known.
class CellPass {
public:
    /// The cloud, of so many points, must outlive it.
    CellPass(const ScratchCloud& cloud, std::size_t points) : cloud_(cloud), points_(points) {}
    virtual ~CellPass() = default;
    CellPass(const CellPass&) = delete;
    CellPass& operator=(const CellPass&) = delete;

    /// The cells of a range; `octree` knows the points of it and of so many voxels around. Cells with points
    /// whose neighbours may lie farther off than half of that are put off.
    void add(const Octree& octree, const VoxelRange& range, int ghost);
    /// Those that were put off, with twice as much around them each time. For all ranks at the same time.
    /// Throws Error where neighbours are farther off than any tile sees.
    void add_far_cells(ScratchCloud& cloud);

    /// Those put off so far; and more that another pass has put off where so much was around them.
    const std::vector<MortonCode>& far_cells() const { return far_cells_; }
    void put_off(const std::vector<MortonCode>& cells, int ghost);

protected:
    /// The cell of a point of an octree.
    MortonCode cell_of(const Octree& octree, std::size_t point) const {
        return octree.codes[point] >> 3 * (morton_levels - cloud_.cell_depth());
    }
    /// Does a cell belong to the range?
    bool is_own(const VoxelRange& range, MortonCode cell) const {
        return range.holds(cell << 3 * (cloud_.depth() - cloud_.cell_depth()));
    }

private:
    /// Looks at the points of a range; returns per point of the octree how far its farthest neighbour is, 0
    /// if that does not matter.
    virtual std::vector<double> look(const Octree& octree, const VoxelRange& range) = 0;
    /// Takes what look() found of a cell's points.
    virtual void take(const Octree& octree, std::size_t begin, std::size_t end) = 0;

    const ScratchCloud& cloud_;
    std::size_t points_;
    int widest_ = 0; // so many voxels have been looked at around cells that were put off
    std::vector<MortonCode> far_cells_;
};

} // namespace hsdm
