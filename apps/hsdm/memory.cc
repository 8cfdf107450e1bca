// Large arrays in huge pages, made ready by all threads: where a host has to find the memory first that takes
// a sixth of a run's processor time, and most arrays are filled by one thread while the others wait.

#include "hsdm/core/huge_pages.hh"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

/// A byte of each page is written. No thread takes up other work here: it could ask for memory in turn. Where
/// there is none for the tasks, pages are found when they are used, as they would be without this.
void touch(unsigned char* memory, std::size_t size) {
    constexpr std::size_t page = 4096, block = std::size_t(1) << 21;
    try {
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(std::size_t{0}, (size + block - 1) / block, [&](std::size_t k) {
                const std::size_t end = std::min(size, (k + 1) * block);
                for (std::size_t i = k * block; i < end; i += page)
                    *static_cast<volatile unsigned char*>(memory + i) = 0;
            });
        });
    } catch (const std::bad_alloc&) {
    }
}

} // namespace

void* operator new(std::size_t size) {
    constexpr std::size_t large = std::size_t(1) << 22;
    constexpr std::size_t largest = std::size_t(1) << 28; // to touch: beyond, what stays unused counts more
    void* const memory = std::malloc(size > 0 ? size : 1);
    if (!memory) throw std::bad_alloc();
    if (size >= large) {
        hsdm::advise_huge_pages(memory, size);
        if (size <= largest) touch(static_cast<unsigned char*>(memory), size);
    }
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
