#pragma once
// Corners and sides of the facets of the dual mesh: the facet that is dual to a crossing has one corner in
// each of the four voxels round the crossed grid edge.

#include "hsdm/types.hh"

#include <array>
#include <compare>

namespace hsdm {

/// Corner j of the facet dual to a crossing. The voxels, and so the corners, are numbered round the grid
/// edge, seen from the tip of its axis a: voxel j lies on the
///   j = 0: lower b, lower c   1: upper b, lower c   2: upper b, upper c   3: lower b, upper c
/// side, with b, c the axes after a. A facet whose crossing leaves the solid runs this way, others against
/// it.
///
/// The same number names the facet's side (half-edge) from this corner to the next, as FacetSide: it passes
/// through the grid face between voxels j and j + 1. The side of a grid point, inside or outside, and the
/// sides of a thin part are other things.
class FacetCorner {
public:
    constexpr FacetCorner() = default; ///< none
    constexpr FacetCorner(Index crossing, unsigned j) : number_(4 * crossing + j) {}

    Index crossing() const { return number_ / 4; }
    unsigned j() const { return number_ % 4; }
    /// Ascends by crossing, then by j.
    Index number() const { return number_; }
    auto operator<=>(const FacetCorner&) const = default;

    FacetCorner next() const { return {crossing(), (j() + 1) % 4}; }
    FacetCorner previous() const { return {crossing(), (j() + 3) % 4}; }
    FacetCorner opposite() const { return {crossing(), (j() + 2) % 4}; }
    /// The one of the corner's two sides that `side` is not.
    FacetCorner other_side(FacetCorner side) const { return side == *this ? previous() : *this; }
    /// Which of the voxels round the edge's lower grid point it lies in: bit k is set on the upper side of
    /// axis k.
    unsigned octant(unsigned edge_axis) const {
        const unsigned upper_b = j() == 1 || j() == 2, upper_c = j() >= 2;
        return 1u << edge_axis | upper_b << (edge_axis + 1) % 3 | upper_c << (edge_axis + 2) % 3;
    }

    /// Of a side: does it lead to the upper of its two voxels?
    bool ascends() const { return j() < 2; }
    /// Its ends in the lower and in the upper voxel.
    FacetCorner low() const { return ascends() ? *this : next(); }
    FacetCorner high() const { return ascends() ? next() : *this; }

private:
    Index number_ = no_index;
};

using FacetSide = FacetCorner;
inline constexpr FacetSide no_side{};

/// The four corners of the facet dual to a crossing.
inline std::array<FacetCorner, 4> corners_of_facet(Index crossing) {
    return {FacetCorner{crossing, 0}, {crossing, 1}, {crossing, 2}, {crossing, 3}};
}

/// The corner that lies in the same voxel as `corner`, across its facet's side `side`, whose twin is `twin`.
inline FacetCorner across(FacetCorner corner, FacetSide side, FacetSide twin) {
    return corner == side.low() ? twin.low() : twin.high();
}

} // namespace hsdm
