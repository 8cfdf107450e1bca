#pragma once
// What the command is at, for the message of a bad end.

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

/// `out of memory in phase facets; ...`, to stand behind the file's name.
std::string out_of_memory();

} // namespace hsdm::command
