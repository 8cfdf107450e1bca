#include "hsdm/core/huge_pages.hh"

#include "hsdm/core/system.hh"

#include <cstdint>

namespace hsdm {

void advise_huge_pages(void* memory, std::size_t bytes) {
    constexpr std::uintptr_t huge_page = std::uintptr_t(1) << 21;
    // Only whole huge pages inside the block: its neighbours in memory are not ours to advise on.
    const std::size_t before = -reinterpret_cast<std::uintptr_t>(memory) & (huge_page - 1);
    if (bytes < before) return;
    const std::size_t whole = (bytes - before) & ~(huge_page - 1);
    if (whole > huge_page) os::advise_huge_pages(static_cast<char*>(memory) + before, whole);
}

} // namespace hsdm
