#pragma once
// Vertices at which no triangles intersect, told without comparing these pair by pair.

#include "hsdm/facets/triangulate.hh"

#include <cstdint>

namespace hsdm {

/// Per vertex, 1 if the triangles round it are one closed fan that, seen along some direction, covers nothing
/// twice: two of them meet in the vertex and the side that they share and nowhere else. `vertex` is the
/// number of each position's vertex. Not every such vertex is found; none is named wrongly, whatever the
/// rounding. O(t), parallel.
std::vector<std::uint8_t> flat_fans(const std::vector<Vec3>& positions,
                                    const std::vector<Triangle>& triangles, const std::vector<Index>& vertex);

} // namespace hsdm
