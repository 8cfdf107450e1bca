#pragma once
// Bent sheets of quads.

#include "support/meshes.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm::support {

/// Quads over u in [0, 1] and v in [0, 1], `at` giving their corners; a torn grid, so that no line of it lies
/// on a ruling.
template <class At>
PolygonMesh grid(Index columns, Index rows, const At& at) {
    return quad_sheet(columns, rows, [&](Index c, Index r) {
        const double shear =
            c == 0 || c == columns || r == 0 || r == rows ? 0 : 0.4 * std::sin(7.0 * c + 5.0 * r);
        return at((c + shear) / columns, static_cast<double>(r) / rows);
    });
}

/// Angle 0 to `angle` round the y axis at `radius`, then along y; outward.
inline PolygonMesh arc(double radius, double angle, double narrowing = 0, Index columns = 180,
                       Index rows = 80) {
    return grid(columns, rows, [&](double u, double v) {
        const double r = radius * (1 - narrowing * v);
        return Vec3(r * std::sin(angle * u), v, r * std::cos(angle * u));
    });
}

/// Inside out.
inline PolygonMesh reversed(PolygonMesh mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f], mesh.corners.begin() + mesh.first[f + 1]);
    return mesh;
}

} // namespace hsdm::support
