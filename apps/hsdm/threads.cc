#include "threads.hh"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace hsdm::command {

void start_threads() {
    // With one place, no thread is made before one is needed.
    tbb::task_arena arena(1);
    arena.execute([] { tbb::parallel_for(0, 2, [](int) {}); });
}

void bound_threads(int threads) {
    // Never destroyed: its destructor asks for memory, and ends the process if there is none.
    [[maybe_unused]] static const auto* const bound = new tbb::global_control(
        tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
}

} // namespace hsdm::command
