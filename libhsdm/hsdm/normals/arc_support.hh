#pragma once
// How many neighbours of a point planes and arcs through it explain, in the widest lanes that the processor
// has.

#include "hsdm/normals/constants.hh"
#include "hsdm/types.hh"

#include <array>
#include <span>

namespace hsdm {

/// A point's neighbours.
struct ArcNeighbors {
    static constexpr std::size_t most = 64; ///< as many as Neighbors holds per point

    std::size_t count = 0;
    double inverse_tolerance = 0;     ///< of the distance from a plane or an arc
    std::array<Vec3, most> normals;   ///< unit
    std::array<Vec3, most> offsets;   ///< as seen from the point
    std::array<double, most> rises{}; ///< normals[k] | offsets[k]: over their own planes
};

/// What the point's own normal may be, as rows of coordinates.
struct ArcCandidates {
    static constexpr std::size_t most = 72; ///< one more than neighbours, filled up to a multiple of 8

    void add(const Vec3& normal) {
        for (unsigned axis = 0; axis < 3; ++axis) rows[axis][count] = normal[axis];
        ++count;
    }
    Vec3 operator[](std::size_t k) const { return {rows[0][k], rows[1][k], rows[2][k]}; }

    std::size_t count = 0;
    alignas(64) std::array<std::array<double, most>, 3> rows;
};

/// Per candidate; what follows those of all candidates is of no use.
struct ArcSupport {
    std::array<double, ArcCandidates::most> plane, arc;
};

/// The same function for lanes of one width: the sums over all neighbours of how close they are to the plane,
/// and to the arc through both points. Neighbours count by the cosine of the two normals, so those across a
/// right angle not at all. All widths say the same to the last bit, as SupportLanes. Rows are filled up to a
/// multiple of 8 first.
using ArcLanes = void (*)(const ArcNeighbors& neighbors, const ArcCandidates& normals, ArcSupport& support);

/// Those that this processor has, the widest first.
std::span<const ArcLanes> arc_lanes();

/// By the widest. Fills up the rows. O(neighbours x candidates).
void support_by_arcs(const ArcNeighbors& neighbors, ArcCandidates& normals, ArcSupport& support);

} // namespace hsdm
