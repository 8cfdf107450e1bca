#pragma once
// Cases in processes of their own: what one takes of memory is its own, and one that crashes ends alone.

#include "outcome.hh"
#include "suite_file.hh"

#include <string>

namespace hsdm::command {

/// What a process is to do beside running the case.
struct CaseTask {
    int threads = 0; ///< at most so many; 0: all
    bool measure_machine = false;
    bool picture = false; ///< draws the mesh
};

/// Runs the case in a new process of this program and waits for it. What ends the process otherwise than by
/// an outcome is a miss. From several threads at once.
Outcome run_in_process(const Case& one, const CaseTask& task);

/// The other side: takes the case from one pipe and gives the outcome to the other, as run_in_process() names
/// them on the command line. Ends the process at once when the first pipe does: whoever waits is gone.
int serve_case(const std::string& pipes);

} // namespace hsdm::command
