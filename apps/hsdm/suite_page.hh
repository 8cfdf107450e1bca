#pragma once
// A suite's outcomes as a page to look at.

#include "outcome.hh"
#include "suite_baseline.hh"
#include "suite_file.hh"

#include <string>
#include <vector>

namespace hsdm::command {

/// What the page shows.
struct SuitePage {
    std::string suite, baseline;          ///< paths; the baseline's is empty where there is none
    const Baseline* before = nullptr;     ///< null where there is none
    const std::vector<Case>& cases;       ///< those that were run
    std::vector<std::string> gone;        ///< names of cases of the baseline that are no more
    const std::vector<Outcome>& outcomes; ///< of the first of the cases, in their order
};

/// HTML that is whole in itself: pictures and all, it loads nothing. Without its script it is a table that
/// says all the same; with it rows are sorted and filtered.
std::string to_html(const SuitePage& page);

} // namespace hsdm::command
