#pragma once
// Vertices at which no facets intersect, found without comparing facets pair by pair.

#include "hsdm/polygon_mesh.hh"

#include <cstdint>

namespace hsdm {

/// Per vertex, 1 if the facets round it are one closed fan that, seen along some direction, covers nothing
/// twice: however they are cut into triangles, two of them meet in the vertex and the side that they share
/// and nowhere else, and no triangle or quad among them is folded onto itself. `vertex` is the number of each
/// position's vertex. Not every such vertex is found; none is named wrongly, whatever the rounding.
/// O(corners), parallel; the same for any number of threads.
std::vector<std::uint8_t> flat_fans(const PolygonMesh& mesh, const std::vector<Index>& vertex);

} // namespace hsdm
