#include "module_watch.hh"

#include "command.hh"
#include "messages.hh"

#include "hsdm/io/file_registry.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace hsdm::command {
namespace {

struct Crash {
    int signal;
    std::string_view name;
};
constexpr std::array<Crash, 5> crashes{{{SIGSEGV, "segmentation fault"},
                                        {SIGBUS, "bus error"},
                                        {SIGFPE, "arithmetic exception"},
                                        {SIGILL, "illegal instruction"},
                                        {SIGABRT, "abort"}}};

// A handler of signals finds all it needs here and calls nothing that allocates, locks or waits.
std::array<char, 4096> where_now;
std::atomic<std::size_t> where_length = 0; ///< 0: no module runs
std::atomic_flag has_ended;
std::array<struct sigaction, crashes.size()> actions_before;
stack_t stack_before;
alignas(16) std::array<char, 1 << 16> stack_of_handlers;

void write_some(std::string_view text) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

/// One line, past a progress bar; the parts come out as one if the pipe has room.
void say(std::string_view what, std::string_view detail) {
    write_some("hsdm: ");
    write_some({where_now.data(), where_length});
    write_some(what);
    write_some(detail);
    write_some("\n");
}

void on_crash(int signal) {
    if (has_ended.test_and_set()) // another thread is on its way to end the process
        for (;;) pause();
    const auto found = std::find_if(crashes.begin(), crashes.end(),
                                    [=](const Crash& crash) { return crash.signal == signal; });
    say(" crashed: ", found == crashes.end() ? "signal" : found->name);
    remove_temporaries_unless_locked();
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigaction(signal, &action, nullptr);
    raise(signal); // is delivered when this handler has returned
}

void on_exit() {
    if (where_length == 0 || has_ended.test_and_set()) return;
    say(" ended the program", "");
    remove_temporaries_unless_locked();
    _exit(failed);
}

} // namespace

ModuleWatch::ModuleWatch(const std::string& where) {
    const std::string text = printable(where);
    where_length = std::min(text.size(), where_now.size());
    std::copy_n(text.begin(), where_length.load(), where_now.begin());
    static const bool registered = std::atexit(on_exit) == 0;
    static_cast<void>(registered);
    stack_t stack{};
    stack.ss_sp = stack_of_handlers.data();
    stack.ss_size = stack_of_handlers.size();
    sigaltstack(&stack, &stack_before);
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < crashes.size(); ++i)
        sigaction(crashes[i].signal, &action, &actions_before[i]);
}

ModuleWatch::~ModuleWatch() {
    for (std::size_t i = 0; i < crashes.size(); ++i)
        sigaction(crashes[i].signal, &actions_before[i], nullptr);
    sigaltstack(&stack_before, nullptr); // a sanitizer's, or none
    where_length = 0;
}

} // namespace hsdm::command
