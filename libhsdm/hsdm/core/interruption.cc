#include "hsdm/core/interruption.hh"

#include "hsdm/errors.hh"

#include <tbb/task_group.h>

#include <utility>

namespace hsdm {
namespace {

constexpr std::chrono::milliseconds asking_interval{50};

/// What the work that this thread has started asks.
thread_local Interruption* innermost = nullptr;

} // namespace

Interruption::Interruption(std::function<bool()> goes_on)
    : goes_on_(std::move(goes_on)),
      next_(Clock::now() + asking_interval),
      outer_(std::exchange(innermost, this)) {}

Interruption::~Interruption() {
    innermost = outer_;
}

void Interruption::poll() {
    Interruption* const one = innermost;
    if (one == nullptr || Clock::now() < one->next_) return;
    const bool goes_on = one->goes_on_();
    one->next_ = Clock::now() + asking_interval;
    if (!goes_on) throw Cancelled();
}

void run_both(const std::function<void()>& here, const std::function<void()>& elsewhere) {
    tbb::task_group group;
    group.run(elsewhere);
    try {
        here();
    } catch (...) {
        group.cancel();
        try {
            group.wait();
        } catch (...) { // of two failures the first is told
        }
        throw;
    }
    group.wait();
}

} // namespace hsdm
