#pragma once
// Pairs of crossings across grid faces: each pair is an edge of the mesh. The facets form a 2-manifold
// whichever crossings are paired. See docs/sheets.md.

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// Do two crossings face opposite ways, as the two sides of a thin part or of a wedge?
inline bool opposed(const Crossing& x, const Crossing& y) {
    return (x.normal | y.normal) < pairing::opposed_cosine;
}

/// What a side of a facet is joined to.
struct Link {
    FacetSide twin;     ///< the side of the other facet; no_side: the surface ends here
    bool rim = false;   ///< does the pair join two opposite sheets, round the rim of a thin part?
    bool bevel = false; ///< does it join two sheets with a third between them in the grid face (mark_bevels)?

    bool open() const { return twin == no_side; }
    /// May there be a strip of facets between the two sides?
    bool strip() const { return rim || bevel; }
};

struct Links {
    std::vector<std::array<Link, 4>> of_crossing; ///< of the four sides of its facet
    /// For each grid face with two links or more: one side of each pair and every open side, then no_side.
    /// Only there can two mesh edges join the same two vertices.
    std::vector<FacetSide> crowded;

    Link& of(FacetSide side) { return of_crossing[side.crossing()][side.j()]; }
    const Link& of(FacetSide side) const { return of_crossing[side.crossing()][side.j()]; }
};

/// Pairs the crossings on the perimeter of every grid face: one that leaves the solid with one that enters
/// it, so that facets are oriented consistently. Of the pairings without links that cross it takes the one
/// whose sheets agree best. O(grid points), parallel.
Links pair_crossings(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related);

} // namespace hsdm
