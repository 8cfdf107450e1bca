#pragma once
// Crossings joined across grid faces: each join is an edge of the mesh, so whatever is joined to whatever,
// the facets form a 2-manifold. See docs/sheets.md.

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// The ring around a crossed edge of axis a, seen from the tip of a: voxel j of the ring lies on the
///   j = 0: lower b, lower c   1: upper b, lower c   2: upper b, upper c   3: lower b, upper c
/// side, with b, c the axes after a; face k of the ring lies between voxels k and k + 1.
struct Ring {
    /// The ring position of the voxel on a face's lower and upper side.
    static constexpr std::array<unsigned, 4> low{0, 1, 3, 0};
    static constexpr std::array<unsigned, 4> high{1, 2, 2, 3};

    static unsigned octant(unsigned axis, unsigned j) {
        const unsigned upper_b = j == 1 || j == 2, upper_c = j >= 2;
        return 1u << axis | upper_b << (axis + 1) % 3 | upper_c << (axis + 2) % 3;
    }
    /// The ring position, in the other crossing's ring, of the voxel at position j in this one, where face k
    /// here is face l there.
    static unsigned across(unsigned j, unsigned k, unsigned l) { return j == low[k] ? low[l] : high[l]; }
};

/// Do two crossings face opposite ways, as the two sides of a thin part or of a wedge?
inline bool opposed(const Crossing& x, const Crossing& y) {
    return (x.normal | y.normal) < pairing::opposed_cosine;
}

/// Where face k of a crossing's ring leads: to which crossing, and which face of that one's ring it is.
struct Link {
    Index crossing = no_index; ///< no_index: the surface ends here
    std::uint8_t face = 0;
    bool rim = false; ///< joins two opposite sheets, not along a sheet or over a blunt crease
};

struct Links {
    std::vector<std::array<Link, 4>> of_crossing;
    std::size_t open = 0; ///< crossings' faces left without a partner: boundary half-edges of the mesh
    std::size_t rims = 0;
    /// The links of faces that hold two or more, one end each, open sides included, with a default Link after
    /// each face's: only there can two mesh edges join the same two vertices.
    std::vector<Link> crowded;
};

/// Pairs the crossings on the perimeter of every grid face, one that leaves the solid with one that enters
/// it, so that orientation is consistent; among several pairings the one whose sheets agree best. O(grid
/// points), parallel.
Links pair_crossings(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related);

} // namespace hsdm
