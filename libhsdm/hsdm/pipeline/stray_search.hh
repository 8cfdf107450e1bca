#pragma once
// Outliers of a cloud on disk that has normals, as drop_outliers_by_normals() finds them in memory.

#include "hsdm/pipeline/cloud_survey.hh"

namespace hsdm {

/// Looks through tiles for points that are of no surface.
class StraySearch {
public:
    /// The cloud must outlive it.
    StraySearch(const ScratchCloud& cloud, const CloudSurvey& survey);

    /// Looks at a range's points; `octree` knows those of it and of so many voxels around. Cells with points
    /// whose neighbours may lie farther off are put off.
    void add(const Octree& octree, const VoxelRange& range, int ghost);
    bool found_here() const { return !strays_.empty() || !far_cells_.empty(); } ///< perhaps, by this rank

    struct Result {
        Occurrences outliers; ///< of all ranks; the first in the cloud's coordinates
        bool moved = false;   ///< does the cloud lie in another cube without them?
    };
    /// Leaves out of `cloud` what all ranks have found, once what was put off has been looked at too. The
    /// survey becomes that of what is left. Points are read `most` or a cell's at a time. For all ranks at
    /// the same time. Throws Error where neighbours are farther off than any tile sees.
    Result leave_out(ScratchCloud& cloud, CloudSurvey& survey, std::size_t most);

private:
    void look_farther(ScratchCloud& cloud);

    const ScratchCloud& cloud_;
    SparseLevel sparse_;
    int widest_ = 0; // so many voxels have been looked at around cells that were put off
    std::vector<MortonCode> far_cells_;
    std::vector<PointRow> strays_;
};

/// The same in one pass over tiles with so many voxels around them. None of the ranges may be of two ranks.
StraySearch::Result drop_strays(ScratchCloud& cloud, CloudSurvey& survey, std::span<const VoxelRange> ranges,
                                int ghost, std::size_t most);

} // namespace hsdm
