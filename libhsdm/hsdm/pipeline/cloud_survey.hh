#pragma once
// The survey of a whole cloud on disk: what its tiles must know of all of it, and what tiles cannot do.

#include "hsdm/pipeline/scratch_cloud.hh"
#include "hsdm/pipeline/survey.hh"

namespace hsdm {

struct CloudSurvey {
    Survey sums;
    double spacing; ///< of the points
};

/// Adds up all groups of at most so many points, of all ranks; twice if `expected` is not how many remain
/// without duplicates, or other ranks have others than points_before() tells. Has the points sorted in their
/// cells.
CloudSurvey survey_cloud(ScratchCloud& cloud, std::size_t expected, std::size_t most_points);

/// Throws Error for a cloud of which PreparedCloud would move or drop points by what all of them are.
void refuse_unfit_places(const CloudSurvey& survey, const ScratchCloud& cloud);

} // namespace hsdm
