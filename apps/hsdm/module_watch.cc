#include "module_watch.hh"

#include "command.hh"
#include "messages.hh"

#include "hsdm/core/system.hh"
#include "hsdm/core/system_process.hh"
#include "hsdm/io/file_registry.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <string_view>

namespace hsdm::command {
namespace {

// A handler of signals finds all it needs here and calls nothing that allocates, locks or waits.
std::array<char, 4096> where_now;
std::atomic<std::size_t> where_length = 0; ///< 0: no module runs
std::atomic_flag has_ended;

void write_some(std::string_view text) {
    [[maybe_unused]] const auto written = os::write(os::standard_error, text.data(), text.size());
}

/// One line, past a progress bar; the parts come out as one if the pipe has room.
void say(std::string_view what, std::string_view detail) {
    write_some("hsdm: ");
    write_some({where_now.data(), where_length});
    write_some(what);
    write_some(detail);
    write_some("\n");
}

bool on_crash(const char* crash) {
    if (has_ended.test_and_set()) return false;
    say(" crashed: ", crash);
    remove_temporaries_unless_locked();
    return true;
}

void on_exit() {
    if (where_length == 0 || has_ended.test_and_set()) return;
    say(" ended the program", "");
    remove_temporaries_unless_locked();
    os::end_at_once(failed);
}

} // namespace

ModuleWatch::ModuleWatch(const std::string& where) {
    const std::string text = printable(where);
    where_length = std::min(text.size(), where_now.size());
    std::copy_n(text.begin(), where_length.load(), where_now.begin());
    static const bool registered = std::atexit(on_exit) == 0;
    static_cast<void>(registered);
    os::watch_crashes(on_crash);
}

ModuleWatch::~ModuleWatch() {
    os::unwatch_crashes();
    where_length = 0;
}

} // namespace hsdm::command
