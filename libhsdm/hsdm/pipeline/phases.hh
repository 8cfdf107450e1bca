#pragma once
// Times the phases of Figure 1 and lets the caller cancel them; shared by the methods.

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/reconstruct.hh"

#include <chrono>
#include <optional>

namespace hsdm {

/// Times the phases of a reconstruction and asks the caller, before each and now and then within it and after
/// it, whether to go on.
class Phases {
public:
    /// `begin` and `end`: the part of the caller's whole work, in [0, 1], that this one is.
    Phases(const ReconstructOptions& options, double begin = 0, double end = 1)
        : options_(options), begin_(begin), end_(end) {
        if (options.progress)
            asking_.emplace([this] { return share_ < 0 || options_.progress(current_, share_); });
    }

    /// Runs `work`, adds its time to `seconds` and returns what it returns. `done` in [0, 1] is how far this
    /// reconstruction is when it starts. Throws Cancelled.
    template <class Work>
    auto run(const char* name, double done, double& seconds, const Work& work) const {
        current_ = name;
        const Timer timer(seconds);
        if (!options_.progress) return work();
        share_ = begin_ + (end_ - begin_) * done;
        if (!options_.progress(name, share_)) throw Cancelled();
        return work();
    }

    /// The phase that runs or ran last.
    const char* current() const { return current_; }

private:
    using Clock = std::chrono::steady_clock;
    class Timer {
    public:
        explicit Timer(double& seconds) : seconds_(seconds) {}
        ~Timer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

    private:
        double& seconds_;
        Clock::time_point start_ = Clock::now();
    };

    const ReconstructOptions& options_;
    double begin_, end_;
    mutable const char* current_ = "begin"; // for the caller only
    mutable double share_ = -1;             // before the first phase nobody is asked
    std::optional<Interruption> asking_;    // of all phases, and of what is done between them
};

} // namespace hsdm
