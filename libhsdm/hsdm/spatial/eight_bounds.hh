#pragma once
// Lower bounds of the distances from a point to eight triangles at once, in the widest lanes that the
// processor has.

#include "hsdm/types.hh"

#include <array>
#include <span>

namespace hsdm {

/// Eight triangles, each as a corner, the unit normal and, in the plane, unit vectors out over the sides that
/// begin at the corner (0, 1) and the one across (2), which lies `across` farther out. A triangle is no
/// nearer than its plane and than the farthest of the lines of its sides that a point lies beyond; beyond
/// none of them it is as near as its plane.
struct EightBounds {
    static constexpr std::size_t size = 8;
    using Row = std::array<double, size>;
    using Rows = std::array<Row, 3>;

    void put(std::size_t lane, const Vec3& a, const Vec3& b, const Vec3& c) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            corner[axis][lane] = a[axis];
            out[0][axis][lane] = b[axis]; // until they are prepared
            out[1][axis][lane] = c[axis];
        }
    }
    /// The triangle before a lane again, from that on.
    void fill_up(std::size_t lane) {
        for (Rows* const corners : {&corner, &out[0], &out[1]})
            for (Row& row : *corners)
                for (std::size_t k = lane; k < size; ++k) row[k] = row[lane - 1];
    }

    alignas(64) Rows corner, normal;
    std::array<Rows, 3> out;
    Row across;
};

/// Of squares of distances from triangles: exact ones where the point is beyond none of their sides, bounds
/// where it is beyond one. Infinity where there are none.
struct LeastSquares {
    double above, beyond;
};

/// The same functions for lanes of one width. All widths say the same to the last bit, as those of
/// TriangleLanes.
struct BoundLanes {
    /// Of all lanes, once their corners are there. Of a degenerate triangle no bound is relied on:
    /// every point counts as beyond its sides, and at no distance.
    void (*prepare)(EightBounds& triangles);
    /// Sets per triangle the square of a distance that it is no nearer than, infinity if the point is beyond
    /// none of its sides.
    LeastSquares (*squares)(const EightBounds& triangles, const Vec3& p, EightBounds::Row& beyond);
};

/// Those that this processor has, the widest first.
std::span<const BoundLanes> bound_lanes();

} // namespace hsdm
