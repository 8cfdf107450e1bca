#include "interrupt.hh"

#include "command.hh"

#include <csignal>
#include <unistd.h>

namespace hsdm::command {
namespace {

// A signal handler reaches nothing but static storage; it belongs to the process, as signals do.
volatile std::sig_atomic_t noted = 0;
volatile std::sig_atomic_t end_at_once = 0;

extern "C" void note_interrupt(int) {
    if (end_at_once || noted) {
        constexpr char text[] = "hsdm: cancelled\n";
        [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
        _exit(cancelled);
    }
    noted = 1;
}

} // namespace

void handle_interrupts() {
    struct sigaction action = {};
    action.sa_handler = note_interrupt;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN); // a closed pipe is an error of writing, with a message and status 1
}

bool interrupted() {
    return noted != 0;
}

InterruptEndsProcess::InterruptEndsProcess() {
    end_at_once = 1;
}
InterruptEndsProcess::~InterruptEndsProcess() {
    end_at_once = 0;
}

} // namespace hsdm::command
