#pragma once
// Normals of a cloud on disk that has none, as make_normals() estimates them in memory.

#include "hsdm/normals/normals.hh"
#include "hsdm/pipeline/cloud_outliers.hh"

namespace hsdm {

struct CloudNormalsOptions {
    PlanRanges plan{};
    int ghost_voxels = 0;        ///< round the parts that noise is measured in
    std::size_t most_points = 0; ///< that are read at a time
    std::size_t memory = 0;      ///< bytes that the patches of all may take
    /// Where what is done can be kept: called with what `begun` of a later call has to be, of the cloud and
    /// the survey as they are then; `sided`: else outliers are left out, and nothing more.
    std::function<void(bool sided, const Ranks::Bytes&)> keep{};
    Ranks::Bytes begun{}; ///< empty: nothing is done
};

/// Leaves outliers out, fits the cube to what is left and gives all points normals: the same bits as in one
/// piece. Each part is looked at with as much around it as its results depend on, which is followed up step
/// by step (KnownPoints). Signs are of the whole: the first rank holds all patches, some 60 bytes a point,
/// and the pairs of them, while it finds them. The survey becomes that of what is left, as yet without
/// normals. For all ranks at the same time. Throws Error where the points are to be moved because of noise or
/// have neighbours farther off than tiles see, or where the patches do not fit the memory.
NormalsReport make_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey,
                                 const CloudNormalsOptions& options);

} // namespace hsdm
