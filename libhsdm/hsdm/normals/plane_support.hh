#pragma once
// How many neighbours of a point support each of several planes through it, in the widest lanes that the
// processor has: of estimated normals this is what takes longest.

#include "hsdm/normals/constants.hh"
#include "hsdm/types.hh"

#include <array>
#include <span>

namespace hsdm {

/// Normals of planes through a point, and its neighbours as seen from it, as rows of coordinates.
struct Planes {
    static constexpr std::size_t most = 64; ///< as many as Neighbors holds per point
    using Rows = std::array<std::array<double, most>, 3>;

    void add(const Vec3& normal, const Vec3& offset) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            normals[axis][count] = normal[axis];
            offsets[axis][count] = offset[axis];
        }
        ++count;
    }

    std::size_t count = 0;        ///< of normals and of neighbours: each neighbour's own
    double inverse_tolerance = 0; ///< of the distance from a plane
    alignas(64) Rows normals, offsets;
};

/// Per plane; what follows those of all planes is of no use.
using Support = std::array<double, Planes::most>;

/// The same functions for lanes of one width. All widths say the same to the last bit: each lane does what
/// the others do, in one order, and no product is added without being rounded.
struct SupportLanes {
    /// Sums of the closeness of all neighbours. Rows are filled up to a multiple of 8 first.
    void (*near)(const Planes& planes, Support& support);
    /// Sums of the closeness times the agreement of the neighbour's own normal with the plane's; none of
    /// those that face the other way.
    void (*agreeing)(const Planes& planes, Support& support);
};

/// Those that this processor has, the widest first.
std::span<const SupportLanes> support_lanes();

/// By the widest. Fills up the rows. O(count^2).
void near_planes(Planes& planes, Support& support);
void agreeing_with_planes(Planes& planes, Support& support);

} // namespace hsdm
