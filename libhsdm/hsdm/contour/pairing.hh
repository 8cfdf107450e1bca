#pragma once
// Crossings joined across grid faces: each join is an edge of the mesh, so whatever is joined to whatever,
// the facets form a 2-manifold. See docs/sheets.md.

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
    constexpr double most_cosine = -0.3;
    return (x.normal | y.normal) < most_cosine;
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
/// it, so that orientation is consistent; among several pairings the one whose sheets agree best. O(corners),
/// parallel.
Links pair_crossings(const CornerLattice& lattice, const Crossings& crossings, const NormalSets& sets,
                     const RelationTest& related);

/// Takes back the crossings beyond the end of the data: patches of those not supported that a border reaches.
/// A boundary loop of up to 16 sides is a defect and no border if it has at most 20 without the patches
/// beside it; there a patch goes only if that makes the boundary shorter. A closed surface loses none.
/// Returns the number removed; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t trim_unsupported(Crossings& crossings, const Links& links);

/// Takes back the two crossings of an edge that only the tip of a corner or the end of a crease pokes
/// through: two that are joined to each other on three or four sides and not the two sides of a thin part.
/// Their facets would lie back to back, between vertices of which two have no other facet. Returns the number
/// of pairs; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t drop_tips(const NormalSets& sets, const RelationTest& related, const Links& links,
                      Crossings& crossings);

} // namespace hsdm
