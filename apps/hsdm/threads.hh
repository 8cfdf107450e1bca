#pragma once
// The threads of the whole command.

namespace hsdm::command {

/// Starts TBB. To be called before anything else does: if memory ends while it starts, every later use of it
/// waits for ever, so nothing may use it then. Throws std::bad_alloc.
void start_threads();

/// More would each take a stack and find nothing to do.
constexpr int most_threads = 256;

/// At most so many, most_threads or fewer, from now on until the process ends. To be called once.
void bound_threads(int threads);

} // namespace hsdm::command
