#include "interrupt.hh"

#include "activity.hh"
#include "command.hh"

#include "hsdm/core/system.hh"
#include "hsdm/core/system_process.hh"
#include "hsdm/io/file_registry.hh"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <thread>
#include <utility>

namespace hsdm::command {
namespace {

/// Until it is true, for about so many milliseconds at most.
template <class Predicate>
void wait_until(const Predicate& is_true, int patience) {
    for (int waited = 0; !is_true() && waited < patience; ++waited)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// One line for standard error, put together without asking for memory: there may be none.
class LastWords {
public:
    LastWords& operator<<(std::string_view text) {
        const std::size_t count = std::min(text.size(), sizeof text_ - 1 - length_);
        for (std::size_t i = 0; i < count; ++i) // names may hold anything; a terminal must not obey it
            text_[length_ + i] =
                static_cast<unsigned char>(text[i]) < ' ' || text[i] == '\x7f' ? '?' : text[i];
        length_ += count;
        return *this;
    }

    /// Past a progress bar on a terminal, and the last: whatever else is written to the stream from now on
    /// waits for it for ever, unless a thread that holds the stream got no time for so long. A reader that
    /// reads no more does not keep the process alive.
    void say() {
        constexpr std::string_view wipe = "\r\033[K";
        constexpr int patience = 300; // milliseconds, twice: every core may be busy with other processes
        text_[length_++] = '\n';
        wait_until([] { return os::try_lock(stderr); }, patience);
        if (!os::is_ready_to_write(os::standard_error, patience)) return;
        if (os::is_terminal(os::standard_error)) write_some(wipe);
        write_some({text_, length_});
    }

private:
    static void write_some(std::string_view text) {
        [[maybe_unused]] const auto written = os::write(os::standard_error, text.data(), text.size());
    }

    char text_[4096]; // what a pipe that is ready takes without waiting
    std::size_t length_ = 0;
};

void list(LastWords& words, std::string_view title, const std::vector<std::string>& names) {
    for (const std::string& name : names) words << (&name == &names.front() ? title : ", ") << name;
}

void say_what_stands(LastWords& words, const FilesWritten& files) {
    if (files.complete_count == 0 && files.in_part.empty()) words << "; nothing was written";
    list(words, "; written before: ", files.complete);
    if (files.complete_count > files.complete.size()) {
        char more[64];
        std::snprintf(more, sizeof more, " and %zu more", files.complete_count - files.complete.size());
        words << more;
    }
    list(words, "; in part: ", files.in_part);
}

std::mutex end_mutex;
const std::function<void()>* last_work = nullptr;

[[noreturn]] void end_as_asked(int status) {
    constexpr int patience = 5000; // milliseconds: what joins a job may hang itself
    wait_until([] { return end_mutex.try_lock(); }, patience); // and it is never unlocked
    try {
        if (last_work) (*last_work)();
    } catch (...) { // the message will not list what could not be written
    }
    const FilesWritten& files = abandon_files();
    LastWords words;
    words << "hsdm: cancelled";
    say_what_stands(words, files);
    words.say();
    os::end_at_once(status);
}

/// The terminate handler: an exception has met code that lets none through.
[[noreturn]] void end_by_exception() noexcept {
    const FilesWritten& files = abandon_files();
    LastWords words;
    words << "hsdm: " << current_file() << (*current_file() ? ": " : "");
    try {
        if (const auto cause = std::current_exception()) std::rethrow_exception(cause);
        words << "unexpected end";
    } catch (const std::bad_alloc&) {
        words << "out of memory";
    } catch (const std::exception& error) {
        words << error.what();
    } catch (...) {
        words << "unexpected end";
    }
    words << " in phase " << current_phase();
    say_what_stands(words, files);
    words.say();
    os::end_at_once(failed);
}

} // namespace

void handle_signals() {
    os::let_writing_fail();
    std::set_terminate(end_by_exception);
    os::on_request_to_end(end_as_asked);
}

std::unique_lock<std::mutex> hold_end() {
    return std::unique_lock(end_mutex);
}

LastWork::LastWork(std::function<void()> work) : work_(std::move(work)) {
    const auto held = lock();
    last_work = &work_;
}

LastWork::~LastWork() {
    const auto held = lock();
    last_work = nullptr;
}

} // namespace hsdm::command
