#pragma once
// What the subcommands share: how one is added, and how it ends.

#include <CLI/CLI.hpp>

#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>

namespace hsdm {
class Ranks;
}

namespace hsdm::command {

enum Exit : int { done = 0, failed = 1, wrong_usage = 2 }; // and 128 + a signal

/// Wrong usage found after parsing: its message and status 2.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A subcommand's work, set by the one that was given; returns the exit status.
using Run = std::function<int()>;

/// `ranks`: those that do it together, if there are some.
void add_reconstruct(CLI::App& app, Run& run, Ranks* ranks);
void add_info(CLI::App& app, Run& run);
void add_compare(CLI::App& app, Run& run);
void add_process(CLI::App& app, Run& run);
void add_stages(CLI::App& app, Run& run);
void add_regress(CLI::App& app, Run& run);
void add_manual(CLI::App& app, Run& run);

/// What a process does first of all, before there are threads: how its memory is kept, and that what is meant
/// for a standard stream that is closed goes nowhere else.
void prepare_process();

/// Parses and runs, after prepare_process(); every exception becomes a message on standard error and an exit
/// status. With ranks it is `hsdm-mpi`, which has the subcommand `reconstruct` alone.
int run_command(int argc, char** argv, Ranks* ranks = nullptr);

/// `hsdm: MESSAGE` on standard error, one line: control characters are written out.
void complain(const std::string& message);

} // namespace hsdm::command
