#pragma once
// Outliers of a cloud on disk that has normals, as drop_outliers_by_normals() finds them in memory.

#include "hsdm/pipeline/cell_pass.hh"
#include "hsdm/pipeline/cloud_survey.hh"

namespace hsdm {

/// Throws Error where so many points of no surface are more than are kept in memory.
void refuse_many_strays(std::size_t count);

/// Looks through tiles for points that are of no surface.
class StraySearch final : public CellPass {
public:
    StraySearch(const ScratchCloud& cloud, const CloudSurvey& survey);

    bool has_found() const { return !strays_.empty(); } ///< here, so far

    struct Result {
        Occurrences outliers; ///< of all ranks; the first in the cloud's coordinates
        bool moved = false;   ///< does the cloud lie in another cube without them?
    };
    /// Leaves out of `cloud` what all ranks have found, once what was put off has been looked at too. The
    /// survey becomes that of what is left. Points are read `most` or a cell's at a time. For all ranks at
    /// the same time. Throws Error where neighbours are farther off than any tile sees.
    Result leave_out(ScratchCloud& cloud, CloudSurvey& survey, std::size_t most);

private:
    std::vector<double> look(const Octree& octree, const VoxelRange& range) override;
    void take(const Octree& octree, std::size_t begin, std::size_t end) override;

    SparseLevel sparse_;
    int finest_;                      // level of leaves
    std::vector<std::uint8_t> found_; // of the points that were looked at last
    std::vector<PointRow> strays_;
};

/// The cloud in the cube of what is left of it, as fit_to_points() has it; points are read `most` or a cell's
/// at a time. Does that differ?
bool fit_to_points_left(ScratchCloud& cloud, std::size_t most);

/// The same in one pass over tiles with so many voxels around them. None of the ranges may be of two ranks.
StraySearch::Result drop_strays(ScratchCloud& cloud, CloudSurvey& survey, std::span<const VoxelRange> ranges,
                                int ghost, std::size_t most);

} // namespace hsdm
