#pragma once
// Feet of points on eight triangles at once, in the widest lanes that the processor has.

#include "hsdm/spatial/point_triangle.hh"

#include <span>

namespace hsdm {

/// Eight triangles with precomputed terms, as rows of coordinates. Each says to the last bit what a
/// PreparedTriangle says.
struct EightTriangles {
    static constexpr std::size_t size = 8;
    using Row = std::array<double, size>;
    using Rows = std::array<Row, 3>;

    void put(std::size_t lane, const Vec3& at_a, const Vec3& at_b, const Vec3& at_c) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            a[axis][lane] = at_a[axis];
            b[axis][lane] = at_b[axis];
            c[axis][lane] = at_c[axis];
        }
    }
    /// Triangles without area from a lane on, on whose planes no point has a foot.
    void fill_up(std::size_t lane) {
        for (; lane < size; ++lane) put(lane, Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0));
    }
    /// Of a triangle that has it inside: the foot (PreparedTriangle::foot_inside). O(1).
    NearestOfTriangle foot(std::size_t lane, const Vec3& p) const {
        const auto at = [lane](const Rows& rows) {
            return Vec3(rows[0][lane], rows[1][lane], rows[2][lane]);
        };
        const Vec3 ap = p - at(a);
        const double v = ap | at(towards_b), w = ap | at(towards_c);
        const Vec3 up = at(normal), height = up * ((ap | up) * per_area[lane]);
        return {p - height, height.sqrnorm(), {1 - v - w, v, w}};
    }

    alignas(64) Rows a, b, c;          ///< corners
    Rows normal, towards_b, towards_c; ///< towards: gradients of the barycentric coordinates
    Row per_area;                      ///< one over four times the area squared, 0 if there is none
};

/// The same functions for lanes of one width. All widths say the same to the last bit: each lane does what
/// the others do, in one order, and no product is added without being rounded.
struct TriangleLanes {
    /// Of all lanes, once their corners are there.
    void (*prepare)(EightTriangles& triangles);
    /// A bit for each triangle that has the foot of a point on its plane inside of it.
    unsigned (*feet_inside)(const EightTriangles& triangles, const Vec3& p);
};

/// Those that this processor has, the widest first.
std::span<const TriangleLanes> triangle_lanes();

} // namespace hsdm
