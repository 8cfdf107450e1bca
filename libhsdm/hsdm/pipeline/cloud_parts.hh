#pragma once
// Parts of a cloud on disk, each with as much around it as it takes to know all that is asked of it.

#include "hsdm/normals/known_points.hh"
#include "hsdm/pipeline/cloud_survey.hh"

#include <map>

namespace hsdm {

/// Whole cells of a cloud.
class CloudPart {
public:
    /// `first`: of the whole. `missing`: cells with points that it has not, ascending.
    CloudPart(const ScratchCloud& cloud, std::span<const Survey::FirstPoint> first,
              const ScratchCloud::Surroundings& around, Octree octree, std::vector<MortonCode> missing);

    const VoxelRange& range() const { return around_.range; }
    int ghost() const { return around_.ghost; } ///< voxels around it, or more

    const Octree& octree() const { return octree_; }
    std::size_t begin() const { return begin_; } ///< of its own points, those of the range
    std::size_t end() const { return end_; }
    bool is_whole() const { return missing_.empty(); } ///< has it all cells?
    /// Too few points for as many neighbours as the whole has?
    bool lacks_neighbors(int count) const {
        return !is_whole() && octree_.size() <= static_cast<std::size_t>(count);
    }
    /// Of which of its points these neighbours are those of the whole.
    KnownPoints known_by(const Neighbors& neighbors) const {
        return {octree_, neighbors,
                [this](const VoxelCoord& voxel, int level) { return has_around(voxel, level); }};
    }
    /// Has it all points of the voxels from `lo` to `hi` of a level?
    bool has(const VoxelCoord& lo, const VoxelCoord& hi, int level) const;
    bool has_around(const VoxelCoord& voxel, int level, int reach = 1) const;
    /// The number in the whole cloud of a point of the part.
    Index number(std::size_t point) const;

private:
    ScratchCloud::Surroundings around_;
    Octree octree_;
    int cell_depth_;
    std::vector<MortonCode> missing_;
    std::size_t begin_, end_;
    struct Cell {
        MortonCode code;
        std::size_t first, number; ///< of its first point, here and in the whole
    };
    std::vector<Cell> cells_;
};

/// How many voxels it took around each range so that the part knew all, which the next pass begins with. Of a
/// cloud as its points are; once they are others all is forgotten.
class PartWidths {
public:
    /// `first`: voxels around a part that is not known; a cell at least.
    explicit PartWidths(int first) : first_(first) {}

    int ghost_of(const VoxelRange& range, const ScratchCloud& cloud);
    void note(const VoxelRange& range, int ghost) { ghost_[{range.begin, range.end}] = ghost; }

private:
    int first_;
    std::size_t version_ = 0; // of the points
    std::map<std::pair<MortonCode, MortonCode>, int> ghost_;
};

/// work(part) of each of those ranges that are this rank's and have points; where it returns false, as not
/// all that it needs is known, again with twice as much around it. For all ranks at the same time. Throws
/// Error where that is wider than tiles see.
void for_parts(ScratchCloud& cloud, const Survey& sums, std::span<const VoxelRange> ranges,
               PartWidths& widths, const std::function<bool(const CloudPart&)>& work);

} // namespace hsdm
