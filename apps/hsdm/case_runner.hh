#pragma once
// How a suite's cases are run: each in a process, held against a baseline, again where it is slower.

#include "case_process.hh"
#include "suite_baseline.hh"

#include <condition_variable>
#include <mutex>

namespace hsdm::command {

class CaseRunner {
public:
    /// `baseline` may be null, and must live as long.
    CaseRunner(const CaseTask& task, const Baseline* baseline, const BaselineBounds& bounds)
        : task_(task), baseline_(baseline), bounds_(bounds) {}

    /// Runs the case, from several threads at once. One that takes more than its bounds let it runs again, up
    /// to so many times in all, each time while no other does: the least time and the least memory count, and
    /// the report is that of the quickest run. Two meshes of one case are a miss.
    Outcome run(const Case& one);

private:
    class Turn;

    Outcome run_again(const Case& one, Outcome outcome, const Outcome& before);
    Outcome run_once(const Case& one, bool alone);

    const CaseTask task_;
    const Baseline* const baseline_;
    const BaselineBounds bounds_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int running_ = 0, waiting_ = 0; ///< of those that want to be alone
    bool alone_ = false;
};

} // namespace hsdm::command
