#include "hsdm/core/large_vector.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/huge_pages.hh"

#include <tbb/task_arena.h>

namespace hsdm {

void touch_pages(void* memory, std::size_t bytes) {
    constexpr std::size_t page = 4096, block = std::size_t{1} << 20, small = std::size_t{1} << 22;
    if (bytes < small) return;
    advise_huge_pages(memory, bytes);
    auto* const begin = static_cast<unsigned char*>(memory);
    const auto touch = [&](std::size_t k) {
        const std::size_t end = std::min(bytes, (k + 1) * block);
        for (std::size_t i = k * block; i < end; i += page)
            *static_cast<volatile unsigned char*>(begin + i) = 0;
    };
    // No thread takes up other work here: a vector is made amid anything, also where that is not expected.
    tbb::this_task_arena::isolate([&] { for_each_task(chunk_count(bytes, block), touch); });
}

void fill_blocks(std::size_t n, std::size_t per_block,
                 void (*fill)(void* context, std::size_t begin, std::size_t end), void* context) {
    tbb::this_task_arena::isolate([&] {
        for_each_task(chunk_count(n, per_block),
                      [&](std::size_t k) { fill(context, k * per_block, std::min(n, (k + 1) * per_block)); });
    });
}

} // namespace hsdm
