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

/// Pairs the sides of edges that exactly two triangles share, running opposite ways. All other sides have no
/// twin, nor have those of edges shared with `others`, facets over the same vertices. O(n), parallel in
/// parts.
TriangleSides link_triangles(std::span<const Index> corners, const PolygonMesh& others,
                             std::size_t vertex_count);

} // namespace hsdm
