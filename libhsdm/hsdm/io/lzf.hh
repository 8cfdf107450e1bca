#pragma once
// LZF, the compression inside PCD files.

#include <span>
#include <string_view>

namespace hsdm::io {

/// Three bytes of LZF become at most 264: what any size of the expanded data must be held against.
inline constexpr std::size_t lzf_most_expansion = 88;

/// Expands `packed` into `out`. Returns false, with `out` in any state, unless that is exactly what it fills:
/// when it is cut off, goes on, or refers to what stands before its beginning. O(out).
bool expand_lzf(std::string_view packed, std::span<char> out);

} // namespace hsdm::io
