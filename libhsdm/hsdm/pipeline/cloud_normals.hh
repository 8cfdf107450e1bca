#pragma once
// Normals of a cloud on disk that has none, as make_normals() estimates them in memory.

#include "hsdm/normals/normals.hh"
#include "hsdm/pipeline/cloud_noise.hh"

#include <optional>

namespace hsdm {

struct CloudNormalsOptions {
    CloudPasses passes{};
    CloudScanners scanners{}; ///< relative to the cube
    std::size_t memory = 0;   ///< bytes that the patches of all may take
    /// Where what is done can be kept: called with what `begun` of a later call has to be, of the cloud and
    /// the survey as they are then; `sided`: else outliers are left out, and nothing more.
    std::function<void(bool sided, const Ranks::Bytes&)> keep{};
    Ranks::Bytes begun{}; ///< empty: nothing is done
};

/// Leaves outliers out, fits the cube to what is left, moves noisy points onto their surface (`as_read` then
/// becomes where they were, as of smooth_cloud()) and gives all points normals: the same bits as in one
/// piece. Each part is looked at with as much around it as its results depend on, which is followed up step
/// by step (KnownPoints). Signs are of the whole: the first rank holds all patches, some 60 bytes a point,
/// and the pairs of them, while it finds them. The survey becomes that of what is left, as yet without
/// normals. For all ranks at the same time. Throws Error where points have neighbours farther off than tiles
/// see, or where the patches do not fit the memory.
NormalsReport make_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, const CloudNormalsOptions& options,
                                 std::optional<ScratchCloud>& as_read);

} // namespace hsdm
