#pragma once
// The few types that every stage shares.

#include <OpenMesh/Core/Geometry/VectorT.hh>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

/// Reconstruction of surfaces from scanned points.
namespace hsdm {

/// A point or a direction, in the cloud's units. OpenMesh's own vector, so nothing is converted at the seam.
using Vec3 = OpenMesh::Vec3d;

/// Index of a point, voxel, vertex or facet. Clouds and meshes hold fewer than 2^32 - 1 of each.
using Index = std::uint32_t;
/// Stands for none; no element has it.
inline constexpr Index no_index = 0xffffffffu;

/// Are all coordinates finite?
inline bool is_finite(const Vec3& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Axis-aligned box; empty until the first point is added.
struct Box {
    static constexpr double inf = std::numeric_limits<double>::infinity(); ///< infinity
    Vec3 lo{inf, inf, inf};                                                ///< least coordinates
    Vec3 hi{-inf, -inf, -inf};                                             ///< greatest coordinates

    /// Grows to hold a point.
    void add(const Vec3& p) {
        lo.minimize(p);
        hi.maximize(p);
    }
    /// Grows to hold another box; an empty one changes nothing.
    void add(const Box& b) {
        lo.minimize(b.lo);
        hi.maximize(b.hi);
    }
    /// Whether it holds no point.
    bool empty() const { return lo[0] > hi[0]; }
    /// Lengths of its sides; zero if it is empty.
    Vec3 size() const { return empty() ? Vec3(0, 0, 0) : hi - lo; }
    /// Length of the space diagonal: what errors are normalised by (section 4 of the paper).
    double diagonal() const { return size().norm(); }
    /// The longest side: the edge of the octree's bounding cube (section 3.1).
    double extent() const { return size().max(); }
};

} // namespace hsdm
