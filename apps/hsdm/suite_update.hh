#pragma once
// `regress --update`: expectations brought in line with what was found, in the suite's own text.

#include "outcome.hh"
#include "suite_file.hh"

#include <span>
#include <string>
#include <vector>

namespace hsdm::command {

/// One number or other value of a suite that is to become another.
struct SuiteChange {
    std::size_t index = 0; ///< of the case in the suite
    std::string name;      ///< of the case
    std::string key;       ///< of the report
    std::string bound;     ///< `value`, `min` or `max`; empty: the expectation is a plain value
    Json before, after;
};

/// What must change so that the outcomes, one for each of the cases, are within tolerance: plain values and
/// the `value` of bounds become what was found, `min` and `max` too where it lies beyond them; tolerances
/// stay. Of a case of several files a bound becomes what holds for all. What is within tolerance stays as it
/// is, and so does what no value could mend: a key that the report does not have, a bound for what is no
/// number, a case without a report, files that differ.
std::vector<SuiteChange> changes_to(std::span<const Case> cases, std::span<const Outcome> outcomes);

/// Whether no miss is left once the changes are made.
bool mends_all(const std::vector<SuiteChange>& changes, std::span<const Case> cases,
               std::span<const Outcome> outcomes);

/// The suite's text with the changes made, every other byte as it was. `text` is one that parse_suite()
/// takes. O(bytes + changes * bytes of their case).
std::string with_changes(const std::string& text, std::vector<SuiteChange> changes);

/// `part, depth 5: mesh.faces 1200 -> 1301`, one line.
std::string line_of(const SuiteChange& change);

} // namespace hsdm::command
