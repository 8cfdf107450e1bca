#include "activity.hh"

#include "messages.hh"

#include "hsdm/errors.hh"

#include <atomic>
#include <new>
#include <stdexcept>

namespace hsdm::command {
namespace {

// Signals and std::terminate belong to the process, and so does what they tell.
std::atomic<const char*> file_now{""};
std::atomic<const char*> phase_now{"start"};

// Of cases that run side by side each tells its own; threads that set nothing have the process's.
thread_local const char* file_here = nullptr;
thread_local const char* phase_here = nullptr;

} // namespace

void set_activity(const char* file, const char* phase) noexcept {
    file_now = file_here = file;
    set_phase(phase);
}

void set_phase(const char* phase) noexcept {
    phase_now = phase_here = phase;
}

const char* current_file() noexcept {
    return file_here ? file_here : file_now.load();
}

const char* current_phase() noexcept {
    return phase_here ? phase_here : phase_now.load();
}

std::string message_of(const std::exception& error) {
    if (dynamic_cast<const Error*>(&error) || dynamic_cast<const OptionError*>(&error))
        return words_of(error);
    const std::string file = current_file(), in_phase = std::string(" in phase ") + current_phase();
    const std::string prefix = file.empty() ? "" : file + ": ";
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
        return prefix + "out of memory" + in_phase + memory_advice;
    return prefix + words_of(error) + in_phase;
}

} // namespace hsdm::command
