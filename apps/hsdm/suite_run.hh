#pragma once
// The cases of a suite, run.

#include "outcome.hh"
#include "suite_file.hh"

#include "hsdm/polygon_mesh.hh"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace hsdm::command {

/// Reconstructs, measures what the case expects, and holds it against that; of a case that must fail, how it
/// failed. What goes wrong is a miss. The mesh, if there is one, goes to `mesh`, if it is not null; that
/// takes none of the outcome's time.
Outcome run_case(const Case& one, PolygonMesh* mesh = nullptr);

/// How far the cases of a suite are: for each its outcome, once it is done.
struct SuiteProgress {
    std::vector<std::optional<Outcome>> outcomes;
    std::vector<char> begun; ///< by case: whether it runs, or did

    /// Those that are done, in the suite's order, and those that have begun, as interrupted.
    std::vector<Outcome> so_far(std::span<const Case> cases) const;
};

/// Runs the cases by `run`, `jobs` (>= 1) of them at a time, and hands each outcome to `show` on the calling
/// thread, in the suite's order, as soon as it and all before it are there. `change` is called for every
/// change of the progress, with what makes it, so that a caller can keep others from looking meanwhile.
void run_cases(std::span<const Case> cases, int jobs, const std::function<Outcome(const Case&)>& run,
               SuiteProgress& progress, const std::function<void(const std::function<void()>& make)>& change,
               const std::function<void(const Outcome&)>& show);

} // namespace hsdm::command
