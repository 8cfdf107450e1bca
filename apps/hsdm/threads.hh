#pragma once
// The threads of the whole command.

namespace hsdm::command {

/// Starts TBB. To be called before anything else does: if memory ends while it starts, every later use of it
/// waits for ever, so nothing may use it then. Throws std::bad_alloc.
void start_threads();

/// At most so many from now on, until the process ends.
void bound_threads(int threads);

} // namespace hsdm::command
