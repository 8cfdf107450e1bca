#include "progress_bar.hh"

#include "messages.hh"

#include "hsdm/core/system.hh"

#include <algorithm>
#include <cstdio>

namespace hsdm::command {

using namespace std::chrono_literals;

ProgressBar::ProgressBar(Progress mode, const std::string& title)
    : mode_(mode),
      title_(printable(title)),
      start_(Clock::now()),
      terminal_(os::is_terminal(os::standard_error)) {}

ProgressBar::~ProgressBar() {
    wipe();
}

void ProgressBar::wipe() {
    if (drawn_ && terminal_) std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
}

void ProgressBar::show(const char* phase, double done) {
    if (mode_ == Progress::never) return;
    const auto now = Clock::now();
    if (mode_ == Progress::automatic && (!terminal_ || now - start_ < 1s)) return;
    if (terminal_ && drawn_ && now - last_ < 50ms) return;
    last_ = now;
    drawn_ = true;
    constexpr int width = 30;
    const double share = std::clamp(done, 0.0, 1.0);
    const std::string bar(static_cast<std::size_t>(share * width), '=');
    // Into a file or a pipe (--progress always) each step is a line of its own.
    std::fprintf(stderr, "%s%s [%-*s] %3.0f%% %s%s", terminal_ ? "\r" : "", title_.c_str(), width,
                 bar.c_str(), 100 * share, phase, terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
}

} // namespace hsdm::command
