#include "case_runner.hh"

#include <algorithm>
#include <utility>

namespace hsdm::command {
namespace {

/// The quicker one's, with the least of what both took.
Outcome better(Outcome first, Outcome second) {
    const std::size_t memory = std::min(first.peak_memory_bytes, second.peak_memory_bytes);
    if (second.seconds < first.seconds) std::swap(first, second);
    first.peak_memory_bytes = memory;
    return first;
}

bool is_beyond(const AgainstBaseline& held) {
    return held.slower || held.more;
}

} // namespace

/// A case's turn, which ends even where running it throws: the others wait for it.
class CaseRunner::Turn {
public:
    Turn(CaseRunner& runner, bool alone) : runner_(runner), alone_(alone) {
        std::unique_lock lock(runner_.mutex_);
        if (alone_) {
            ++runner_.waiting_;
            runner_.changed_.wait(lock, [this] { return runner_.running_ == 0; });
            --runner_.waiting_;
            runner_.alone_ = true;
        } else {
            runner_.changed_.wait(lock, [this] { return !runner_.alone_ && runner_.waiting_ == 0; });
        }
        ++runner_.running_;
    }
    ~Turn() {
        {
            const std::lock_guard lock(runner_.mutex_);
            --runner_.running_;
            if (alone_) runner_.alone_ = false;
        }
        runner_.changed_.notify_all();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    CaseRunner& runner_;
    const bool alone_;
};

Outcome CaseRunner::run_once(const Case& one, bool alone) {
    const Turn turn(*this, alone);
    return run_in_process(one, task_);
}

Outcome CaseRunner::run_again(const Case& one, Outcome outcome, const Outcome& before) {
    int runs = 1;
    while (runs < bounds_.runs && is_beyond(hold_against(before, outcome, one, bounds_))) {
        Outcome again = run_once(one, true);
        ++runs;
        if (again.report.is_null()) { // what does not come to a mesh each time is worse than slow
            again.runs = runs;
            return again;
        }
        const Json digest = *find_key(outcome.report, "mesh.digest");
        if (*find_key(again.report, "mesh.digest") != digest) {
            outcome.misses.push_back("made two meshes in two runs: their digests are " + digest.dump()
                                     + " and " + find_key(again.report, "mesh.digest")->dump());
            break;
        }
        outcome = better(std::move(outcome), std::move(again));
    }
    outcome.runs = runs;
    return outcome;
}

Outcome CaseRunner::run(const Case& one) {
    Outcome outcome = run_once(one, false);
    const Outcome* const before = baseline_ ? baseline_->find(one) : nullptr;
    if (!before) return outcome;
    if (!outcome.report.is_null()) outcome = run_again(one, std::move(outcome), *before);
    outcome.baseline = hold_against(*before, outcome, one, bounds_);
    const std::vector<std::string> misses = misses_of(outcome, one, bounds_);
    outcome.misses.insert(outcome.misses.end(), misses.begin(), misses.end());
    return outcome;
}

} // namespace hsdm::command
