#pragma once
// Pairs of crossings across grid faces: each pair is an edge of the mesh. The facets form a 2-manifold
// whichever crossings are paired. See docs/sheets.md.

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// The ring around a crossed edge of axis a, seen from the tip of a: voxel j of the ring lies on the
///   j = 0: lower b, lower c   1: upper b, lower c   2: upper b, upper c   3: lower b, upper c
/// side, with b, c the axes after a; face k of the ring lies between voxels k and k + 1.
struct Ring {
    /// Per face of the ring, the ring position of the voxel on its lower and on its upper side.
    static constexpr std::array<unsigned, 4> low{0, 1, 3, 0};
    static constexpr std::array<unsigned, 4> high{1, 2, 2, 3};

    static unsigned octant(unsigned axis, unsigned j) {
        const unsigned upper_b = j == 1 || j == 2, upper_c = j >= 2;
        return 1u << axis | upper_b << (axis + 1) % 3 | upper_c << (axis + 2) % 3;
    }
    /// Two crossings joined across face k of one ring, which is face l of the other: the voxel beside that
    /// face at position j of the first ring is at this position of the second.
    static unsigned across(unsigned j, unsigned k, unsigned l) { return j == low[k] ? low[l] : high[l]; }
};

/// Do two crossings face opposite ways, as the two sides of a thin part or of a wedge?
inline bool opposed(const Crossing& x, const Crossing& y) {
    return (x.normal | y.normal) < pairing::opposed_cosine;
}

/// The partner of a crossing across face k of its ring, and the number of that face in the partner's ring.
struct Link {
    Index crossing = no_index; ///< no_index: the surface ends here
    std::uint8_t face = 0;
    bool rim = false; ///< does the pair join two opposite sheets, round the rim of a thin part?
};

struct Links {
    std::vector<std::array<Link, 4>> of_crossing;
    /// crossings without a partner across a face, one per face: boundary half-edges of the mesh
    std::size_t open = 0;
    std::size_t rims = 0;
    /// The links of grid faces that hold at least two (one end of each pair; open sides count), each face's
    /// list ended by a default Link. Only in such faces can two mesh edges join the same two vertices.
    std::vector<Link> crowded;
};

/// Pairs the crossings on the perimeter of every grid face: one that leaves the solid with one that enters
/// it, so that facets are oriented consistently. Of several possible pairings it takes the one whose sheets
/// agree best. O(grid points), parallel.
Links pair_crossings(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related);

} // namespace hsdm
