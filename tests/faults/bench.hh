#pragma once
// The command under faults: one call of it in a folder of its own, again and again from the same files.

#include "faults/plan.hh"

#include "cli/run.hh"

#include <map>
#include <string>
#include <vector>

namespace hsdm::faults {

/// Content of every file below a folder, by its path from there.
using Files = std::map<std::string, std::string>;

/// A call of the command, and what it may change.
struct Scenario {
    std::string name;
    std::vector<std::string> arguments;
    Files inputs;
    std::vector<std::string> outputs; ///< files that are there before, with other content
    std::string standard_input = {};  ///< one of the inputs; empty: none
    bool prints_result = false;       ///< standard output is the result, the same in each run
    bool tells_in_table = false;      ///< failures stand in the table on standard output
    bool from_start = false;          ///< allocations fail from main() on, not only from the first open on
};

struct Outcome {
    int status = 0; ///< 128 + signal if one ended it; -1 if it did not end in time
    std::string out, err;
    Files files;
};

/// What a fault was and what it led to.
struct Fault {
    Kind kind = Kind::count;
    std::uint64_t at = 0;
    int error = EIO;
    bool lasting = false;
};

class Bench {
public:
    explicit Bench(Scenario scenario);

    /// Calls of a kind in a run without fault.
    std::uint64_t calls(Kind kind) const { return calls_[static_cast<std::size_t>(kind)]; }

    /// Allocations of it before a file is opened: the command's own start, the same for all its calls.
    std::uint64_t starting_calls() const { return starting_calls_; }

    /// Runs with the fault. Empty if every promise was kept, else what was not. Counts the runs.
    std::string broken_promise(const Fault& fault);

    const Scenario& scenario() const { return scenario_; }
    std::size_t runs() const { return runs_; }
    std::size_t runs_done_in_spite() const { return done_in_spite_; } ///< with status 0

private:
    Outcome run(const Fault& fault);
    int start_and_wait(const std::string& out, const std::string& err) const;
    std::string text_of(const std::string& out) const;
    void put_back(const Files& found) const;
    std::string broken_files(const Outcome& outcome) const;
    std::string broken_message(const Outcome& outcome, const Fault& fault) const;

    Scenario scenario_;
    hsdm::test::Folder folder_, capture_;
    Plan* plan_ = nullptr; ///< mapped; lives as long as the process
    Files before_;
    Outcome clean_;
    std::uint64_t calls_[kinds] = {}, starting_calls_ = 0;
    std::size_t runs_ = 0, done_in_spite_ = 0;
};

} // namespace hsdm::faults
