#pragma once
// Lets whoever started long work stop it while its parallel loops run.

#include <algorithm>
#include <chrono>
#include <cstddef>
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

/// Calls f(i) for each i below n, in order, on this thread, which asks in between: for loops over all of a
/// cloud or mesh that are not parallel. Throws Cancelled.
template <class F>
void for_each_in_order(std::size_t n, F&& f) {
    constexpr std::size_t block = 1 << 13; // far less than asking_interval, far more than the look at a clock
    for (std::size_t begin = 0; begin < n; begin += block) {
        Interruption::poll();
        for (std::size_t i = begin, end = std::min(n, begin + block); i < end; ++i) f(i);
    }
}

/// Calls both, at the same time if threads are free; `here` on this thread, as it is the one that asks, so
/// this should be the one that is less parallel. If one throws the other is given up, and so do its loops:
/// what it leaves is not to be used.
void run_both(const std::function<void()>& here, const std::function<void()>& elsewhere);

} // namespace hsdm
