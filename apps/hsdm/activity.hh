#pragma once
// Records what the command is doing, for the message if it fails.

#include <exception>
#include <string>

namespace hsdm::command {

/// Records that the command is working on `file` in the phase `phase`. Both are kept as pointers, because
/// they are read from other threads and when no memory is left: they must stay valid until the next call.
void set_activity(const char* file, const char* phase) noexcept;
/// Another phase of the same file.
void set_phase(const char* phase) noexcept;

/// What this thread has set, else what any thread set last; never null, "" before the first.
const char* current_file() noexcept;
const char* current_phase() noexcept;

constexpr const char* memory_advice = "; use a smaller --depth, a larger --max-error or a thinned cloud";

/// The message for an exception, to be called when the memory of the failed work is free again: hsdm's own
/// exceptions have messages; others, such as std::bad_alloc, get the file and the phase.
std::string message_of(const std::exception& error);

} // namespace hsdm::command
