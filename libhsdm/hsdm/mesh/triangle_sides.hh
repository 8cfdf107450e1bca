#pragma once
// Which sides of triangles are twins. Side s of a list of triangles, three corners each, runs from corner s
// to corner next_side(s).

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

inline Index next_side(Index s) {
    return s % 3 == 2 ? s - 2 : s + 1;
}
inline Index previous_side(Index s) {
    return s % 3 == 0 ? s + 2 : s - 1;
}

struct TriangleSides {
    std::vector<Index> twin;          ///< per side, the one that runs the other way, or no_index
    std::vector<std::uint8_t> border; ///< per vertex
    bool crowded = false;             ///< has some edge more than two sides, or two that run the same way?
};

/// Sides that not just two triangles share, one running either way, have no twin; nor have those shared with
/// `others`, facets of the same vertices. O(n), parallel in parts.
TriangleSides link_triangles(std::span<const Index> corners, const PolygonMesh& others,
                             std::size_t vertex_count);

} // namespace hsdm
