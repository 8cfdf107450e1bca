#pragma once
// Lets whoever started long work stop it while its parallel loops run.

#include <chrono>
#include <functional>

namespace hsdm {

/// While one lives, the thread that made it asks `goes_on` between the tasks that it takes of its parallel
/// loops (for_each_task), at most every 50 ms. Once the answer is false, Cancelled is thrown out of the loop,
/// when tasks that other threads are at have ended. One a thread at a time; the innermost counts.
class Interruption {
public:
    explicit Interruption(std::function<bool()> goes_on);
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Asks if it is time to. Throws Cancelled.
    static void poll();

private:
    using Clock = std::chrono::steady_clock;

    std::function<bool()> goes_on_;
    Clock::time_point next_;
    Interruption* outer_;
};

} // namespace hsdm
