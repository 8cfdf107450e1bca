#include "activity.hh"

#include <atomic>

namespace hsdm::command {
namespace {

// Signals and std::terminate belong to the process, and so does what they tell.
std::atomic<const char*> file_now{""};
std::atomic<const char*> phase_now{"start"};

} // namespace

void set_activity(const char* file, const char* phase) noexcept {
    file_now = file;
    phase_now = phase;
}

void set_phase(const char* phase) noexcept {
    phase_now = phase;
}

const char* current_file() noexcept {
    return file_now;
}

const char* current_phase() noexcept {
    return phase_now;
}

std::string out_of_memory() {
    return std::string("out of memory in phase ") + current_phase() + memory_advice;
}

} // namespace hsdm::command
