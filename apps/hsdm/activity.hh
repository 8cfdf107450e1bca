#pragma once
// What the command is at, for the message of a bad end.

#include <exception>
#include <string>

namespace hsdm::command {

/// From now on `file` is in the phase `phase`. Both are kept as pointers, since they are read when no memory
/// is left and from other threads: they must stay valid until the next call.
void set_activity(const char* file, const char* phase) noexcept;
/// Another phase of the same file.
void set_phase(const char* phase) noexcept;

const char* current_file() noexcept; ///< never null; "" before the first
const char* current_phase() noexcept;

constexpr const char* memory_advice = "; use a smaller --depth, a larger --max-error or a thinned cloud";

/// What to say of an exception once the memory that its work held is free again: hsdm's own speak for
/// themselves, others, such as std::bad_alloc, get the file and the phase.
std::string message_of(const std::exception& error);

} // namespace hsdm::command
