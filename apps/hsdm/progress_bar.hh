#pragma once
// One line on standard error that says how far the work is.

#include <chrono>
#include <string>

namespace hsdm::command {

enum class Progress { automatic, always, never };

class ProgressBar {
public:
    /// automatic: only on a terminal, and only once a second has passed.
    ProgressBar(Progress mode, const std::string& title);
    ~ProgressBar(); ///< wipes the line

    /// Before anything else is printed; the next show() draws anew.
    void wipe();
    void show(const char* phase, double done);

private:
    using Clock = std::chrono::steady_clock;
    Progress mode_;
    std::string title_;
    Clock::time_point start_, last_{};
    bool terminal_, drawn_ = false;
};

} // namespace hsdm::command
