#pragma once
// Section 3.3: what a vertex is on.

#include <cstdint>

namespace hsdm {

/// Fig. 11: (a) smooth vertex, (b) on a sharp edge, (c) sharp corner.
enum class VertexClass : std::uint8_t { smooth = 0, edge = 1, corner = 2 };

} // namespace hsdm
