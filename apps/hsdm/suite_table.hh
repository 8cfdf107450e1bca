#pragma once
// The table that `hsdm regress` prints.

#include "outcome.hh"
#include "suite_file.hh"

#include <iosfwd>
#include <span>
#include <vector>

namespace hsdm::command {

class SuiteTable {
public:
    /// `against_baseline`: rows tell what the baseline's times and memory were multiplied by, and whether the
    /// mesh is still the same.
    SuiteTable(std::ostream& out, std::span<const Case> cases, bool against_baseline);

    void print_head();
    /// A row and a line for each miss, at once.
    void print_row(const Outcome& outcome);

private:
    std::ostream& out_;
    int width_ = 4; ///< of names
    bool against_baseline_;
};

/// `3 slower, 1 of another mesh, 2 not judged (threads: ...)`: a line on how the outcomes with a baseline
/// stand to it, without a line end.
std::string baseline_words(const std::vector<Outcome>& outcomes, const std::vector<std::string>& gone);

} // namespace hsdm::command
