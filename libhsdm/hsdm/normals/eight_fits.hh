#pragma once
// Planes and quadratic heights fitted to the neighbours of eight points at once, in the widest lanes that the
// processor has.

#include "hsdm/normals/plane_fit.hh"

#include <span>

namespace hsdm {

/// The neighbours of eight points, each as seen from its own point.
struct EightOffsets {
    static constexpr std::size_t lanes = 8, most = 64; ///< as many as Neighbors holds per point
    using Row = std::array<double, lanes>;             ///< a value of each point

    std::size_t count = 0;                                 ///< per point
    alignas(64) std::array<std::array<Row, 3>, most> rows; ///< per neighbour: x, y, z

    void set(std::size_t neighbor, std::size_t lane, const Vec3& offset) {
        for (unsigned axis = 0; axis < 3; ++axis) rows[neighbor][axis][lane] = offset[axis];
    }
};

/// The planes with the least squared distances from each point and its neighbours.
struct EightPlanes {
    alignas(64) std::array<EightOffsets::Row, 3> along; ///< the normals, of any length
    EightOffsets::Row variance, trace, gap;             ///< as plane_along() takes them

    PlaneFit of(std::size_t lane) const;
};

/// Per point, what gives the coordinates x, y and z of an offset, z upwards, as its products with three
/// vectors.
struct EightFrames {
    alignas(64) std::array<std::array<EightOffsets::Row, 3>, 3> rows;

    void set(std::size_t lane, const std::array<Vec3, 3>& frame) {
        for (std::size_t k = 0; k < 3; ++k)
            for (unsigned axis = 0; axis < 3; ++axis) rows[k][axis][lane] = frame[k][axis];
    }
};

/// How much a bent sheet tilts the plane that is fitted to it, by the heights z over (x, y) as a quadratic
/// function.
struct EightTilts {
    /// Slope of the best quadratic at the point less the slope of the best plane: how far the plane is off,
    /// and the error of that. 0 where the points do not determine six coefficients.
    alignas(64) std::array<EightOffsets::Row, 2> tilt{};
    EightOffsets::Row
        variance{}; ///< expected |tilt|^2 if there were only noise, by the quadratic's residuals
};

/// The same functions for lanes of one width. All widths say the same to the last bit: each lane does what
/// the others do, in one order, and no product is added without being rounded.
struct FitLanes {
    void (*planes)(const EightOffsets& offsets, EightPlanes& planes);
    void (*tilts)(const EightOffsets& offsets, const EightFrames& frames, EightTilts& tilts);
};

/// Those that this processor has, the widest first.
std::span<const FitLanes> fit_lanes();

} // namespace hsdm
