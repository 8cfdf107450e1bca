#pragma once
// Vertices on the border of an open surface.

#include "hsdm/polygon_mesh.hh"

#include <cstdint>

namespace hsdm {

/// Per vertex of an oriented 2-manifold, is it at a border? O(corners).
std::vector<std::uint8_t> border_vertices(const PolygonMesh& mesh);

} // namespace hsdm
