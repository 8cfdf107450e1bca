#pragma once
// Distances from a point to two triangles at once.

#include "hsdm/core/lanes.hh"
#include "hsdm/types.hh"

#include <array>

namespace hsdm {

/// Corner a, the sides from it, and reciprocals of the squared lengths of the three sides and of the squared
/// doubled area, zero where there is none.
struct TwoTriangles {
    std::array<Double2, 3> a, ab, ac;
    Double2 per_ab, per_ac, per_bc, per_area;

    /// Sets the first (0) or the second (1) triangle, given a corner and the two sides from it.
    void put(std::size_t lane, const Vec3& from, const Vec3& to_b, const Vec3& to_c) {
        for (unsigned k = 0; k < 3; ++k) {
            a[k][lane] = from[k];
            ab[k][lane] = to_b[k];
            ac[k][lane] = to_c[k];
        }
        auto reciprocal = [](double x) { return x > std::numeric_limits<double>::min() ? 1 / x : 0; };
        const double bb = to_b.sqrnorm(), cc = to_c.sqrnorm(), bc = to_b | to_c;
        per_ab[lane] = reciprocal(bb);
        per_ac[lane] = reciprocal(cc);
        per_bc[lane] = reciprocal((to_c - to_b).sqrnorm());
        per_area[lane] = reciprocal(bb * cc - bc * bc);
    }

    /// For each triangle: the point's foot on the plane if it lies inside, and the nearest point of each
    /// side. All of them are points of the triangle, so the least of their distances is right even where a
    /// degenerate triangle makes the foot meaningless. No branches: all lanes at once.
    Double2 squared_distances(const std::array<Double2, 3>& point) const {
        const auto& [bx, by, bz] = ab;
        const auto& [cx, cy, cz] = ac;
        const Double2 px = point[0] - a[0], py = point[1] - a[1], pz = point[2] - a[2];
        const Double2 qx = px - bx, qy = py - by, qz = pz - bz;
        const Double2 ex = cx - bx, ey = cy - by, ez = cz - bz;
        const Double2 pb = px * bx + py * by + pz * bz, pc = px * cx + py * cy + pz * cz;

        const Double2 tb = clamp01(pb * per_ab), tc = clamp01(pc * per_ac);
        const Double2 te = clamp01((qx * ex + qy * ey + qz * ez) * per_bc);
        const Double2 to_ab = square(px - tb * bx) + square(py - tb * by) + square(pz - tb * bz);
        const Double2 to_ac = square(px - tc * cx) + square(py - tc * cy) + square(pz - tc * cz);
        const Double2 to_bc = square(qx - te * ex) + square(qy - te * ey) + square(qz - te * ez);
        const Double2 to_sides = min_lanes(to_ab, min_lanes(to_ac, to_bc));

        const Double2 bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
        const Double2 bc = bx * cx + by * cy + bz * cz;
        const Double2 s = (cc * pb - bc * pc) * per_area, t = (bb * pc - bc * pb) * per_area;
        const Double2 to_foot =
            square(px - s * bx - t * cx) + square(py - s * by - t * cy) + square(pz - s * bz - t * cz);
        const Double2 inside = min_lanes(min_lanes(s, t), 1 - s - t);
        return inside >= 0 ? min_lanes(to_foot, to_sides) : to_sides;
    }
};

} // namespace hsdm
