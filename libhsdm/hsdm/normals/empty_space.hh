#pragma once
// The space between the points: which voxels are empty, and which of these lie beside each other.

#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Connected regions of empty voxels in the octree's cube and a margin of one voxel around; region 0 is
/// outside.
class EmptySpace {
public:
    static constexpr Index occupied = no_index - 1; ///< in place of a region

    /// `codes`: of the voxels with points, of a level of this depth. O(8^depth).
    EmptySpace(std::span<const MortonCode> codes, int depth);

    int depth() const { return depth_; }
    std::size_t regions() const { return regions_; }
    /// The region at a voxel, or `occupied`.
    Index region(const VoxelCoord& c) const {
        const auto last = static_cast<std::int32_t>(side_) - 2;
        for (std::int32_t x : c)
            if (x < 0 || x >= last) return 0;
        return label_[cell(c)];
    }

    /// Voxels along an edge of the cube and its margin.
    std::size_t side() const { return side_; }
    /// Place of a voxel of the cube or its margin, x running fastest.
    std::size_t cell(const VoxelCoord& c) const {
        return (static_cast<std::size_t>(c[2] + 1) * side_ + static_cast<std::size_t>(c[1] + 1)) * side_
               + static_cast<std::size_t>(c[0] + 1);
    }
    bool is_empty(std::size_t cell) const { return label_[cell] != occupied; }

private:
    static constexpr Index unlabelled = no_index;
    void flood(std::size_t start);
    void push_runs(std::size_t begin, std::size_t end);

    int depth_;
    std::size_t side_;
    std::vector<Index> label_;
    std::vector<std::size_t> stack_;
    std::size_t regions_ = 0;
};

} // namespace hsdm
