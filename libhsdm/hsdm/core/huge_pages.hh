#pragma once
// Fewer page faults for large arrays.

#include <cstddef>

namespace hsdm {

/// Asks for huge pages under memory that is about to be written for the first time: reading many points is
/// bound by page faults otherwise. Only advice; does nothing for small blocks or where it is not known.
void advise_huge_pages(void* memory, std::size_t bytes);

} // namespace hsdm
