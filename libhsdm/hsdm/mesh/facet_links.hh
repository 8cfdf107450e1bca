#pragma once
// Which sides of facets are twins, and which corners form a fan: the half-edge structure as flat arrays.

#include "hsdm/polygon_mesh.hh"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace hsdm {

/// Side c of a facet runs from corners[c] to the facet's next corner. Sides of rejected facets take no part.
struct FacetLinks {
    std::vector<char> accepted;     ///< per facet
    std::vector<Index> facet;       ///< per side, its facet
    std::vector<Index> twin;        ///< per side, the side running the other way, or no_index
    std::vector<Index> vertex;      ///< per side, its start vertex after splitting and renumbering
    std::vector<Index> source;      ///< per vertex, its index in the facets' positions
    std::vector<Index> side_out;    ///< per vertex, a side that starts there
    std::vector<Index> open_in;     ///< per vertex, the side without twin that ends there, or no_index
    std::size_t rejected = 0;       ///< facets
    std::size_t split_vertices = 0; ///< vertices added at the end, copies of earlier ones
};

/// See to_mesh for what is accepted. Every vertex of the result has exactly one fan of facets, so at most one
/// side without twin ends in it.
FacetLinks link_facets(const PolygonMesh& facets);

/// The side after c, and the one before, in c's facet.
inline Index next_side(const PolygonMesh& facets, Index facet, Index c) {
    return c + 1 == facets.first[facet + 1] ? facets.first[facet] : c + 1;
}
inline Index previous_side(const PolygonMesh& facets, Index facet, Index c) {
    return c == facets.first[facet] ? facets.first[facet + 1] - 1 : c - 1;
}

/// Do two facets have the same vertices? `first`: which of a's, if it has so many, is looked for first,
/// because the others are more likely to be shared by neighbours.
inline bool have_same_vertices(std::span<const Index> a, std::span<const Index> b, std::size_t first = 0) {
    const auto b_has = [b](Index v) { return std::find(b.begin(), b.end(), v) != b.end(); };
    return a.size() == b.size() && (first >= a.size() || b_has(a[first]))
           && std::all_of(a.begin(), a.end(), b_has);
}

/// Calls visit(side) for the sides that start at a vertex of one fan, clockwise, as a half-edge mesh goes
/// round it, from the one behind the border if there is one.
template <class Visit>
void for_sides_from(const PolygonMesh& facets, const FacetLinks& links, Index vertex, const Visit& visit) {
    const auto next = [&](Index side) { return next_side(facets, links.facet[side], side); };
    const Index open = links.open_in[vertex];
    const Index begin = open == no_index ? links.side_out[vertex] : next(open);
    Index side = begin;
    do {
        visit(side);
        const Index twin = links.twin[side];
        if (twin == no_index) return;
        side = next(twin);
    } while (side != begin);
}

} // namespace hsdm
