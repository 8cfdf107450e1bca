// Large arrays in huge pages: with small ones, faults take a twentieth of the time for a million points, and
// most of them happen while the other threads wait.

#include "hsdm/io/huge_pages.hh"

#include <cstdlib>
#include <new>

void* operator new(std::size_t size) {
    constexpr std::size_t large = std::size_t(1) << 22;
    void* const memory = std::malloc(size > 0 ? size : 1);
    if (!memory) throw std::bad_alloc();
    if (size >= large) hsdm::io::advise_huge_pages(memory, size);
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
