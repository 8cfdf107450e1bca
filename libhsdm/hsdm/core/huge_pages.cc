#include "hsdm/core/huge_pages.hh"

#include <sys/mman.h>

#include <cstdint>

namespace hsdm {

void advise_huge_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t huge_page = std::uintptr_t(1) << 21;
    // Only whole huge pages inside the block: its neighbours in memory are not ours to advise on.
    const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + huge_page - 1) & ~(huge_page - 1);
    const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) & ~(huge_page - 1);
    if (end > begin + huge_page) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#else
    static_cast<void>(memory);
    static_cast<void>(bytes);
#endif
}

} // namespace hsdm
