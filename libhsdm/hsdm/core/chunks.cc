#include "hsdm/core/chunks.hh"

#include "hsdm/core/interruption.hh"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace hsdm {

void run_tasks(std::size_t n, void (*task)(void* context, std::size_t i), void* context) {
    tbb::parallel_for(std::size_t{0}, n, [task, context](std::size_t i) {
        Interruption::poll();
        task(context, i);
    });
}

void run_isolated(void (*act)(void* context), void* context) {
    tbb::this_task_arena::isolate([&] { act(context); });
}

} // namespace hsdm
