#pragma once
// An earlier run of a suite, and what of the present one is slower, takes more memory or has another mesh.

#include "outcome.hh"
#include "suite_file.hh"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hsdm::command {

/// What a case may take, as times what it took. A time is missed only by more than `least_seconds`, too, and
/// after so many runs, of which the least counts; memory only by more than 16 MB.
struct BaselineBounds {
    std::optional<double> most_slower, most_memory; ///< of cases that have none of their own
    double least_seconds = 0.1;
    int runs = 3;
};

/// The outcomes that `--json` wrote.
class Baseline {
public:
    /// Throws Error for a file that is none.
    static Baseline read(const std::string& path);

    /// The case's, or none: of several of one name that with the same number.
    const Outcome* find(const Case& one) const;
    /// Names of those that are none of the cases.
    std::vector<std::string> names_without(const std::vector<Case>& cases) const;

private:
    std::map<std::pair<std::string, std::size_t>, Outcome> outcomes_; ///< by name and number of that name
};

/// The outcome against that of the baseline. Times and memory are judged where both came to a mesh, from the
/// same input with the same arguments and threads. Where the fixed work that was measured beside both took
/// longer now, the baseline's time counts as so much longer; a faster machine changes nothing.
AgainstBaseline hold_against(const Outcome& before, const Outcome& now, const Case& one,
                             const BaselineBounds& bounds);

/// A miss for each bound that is not kept.
std::vector<std::string> misses_of(const Outcome& now, const Case& one, const BaselineBounds& bounds);

} // namespace hsdm::command
