#pragma once
// The normal of a polygon, weighted by its area.

#include "hsdm/core/large_vector.hh"
#include "hsdm/polygon_mesh.hh"

#include <algorithm>

namespace hsdm {

/// Twice the facet's area along its normal, in the mesh's units; exact for any polygon, flat or not.
inline Vec3 area_vector(const PolygonMesh& mesh, std::span<const Index> facet) {
    const Vec3& origin = mesh.positions[facet[0]];
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < facet.size(); ++i)
        sum += (mesh.positions[facet[i]] - origin) % (mesh.positions[facet[i + 1]] - origin);
    return sum;
}

/// The same of a polygon's corners.
inline Vec3 area_vector(std::span<const Vec3> corners) {
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (corners[i] - corners[0]) % (corners[i + 1] - corners[0]);
    return sum;
}

/// Per vertex, the sum of the area vectors of the facets round it: its normal, weighted by area. O(corners).
inline std::vector<Vec3> vertex_area_vectors(const PolygonMesh& mesh) {
    std::vector<Vec3> sums = large_vector<Vec3>(mesh.vertex_count(), Vec3(0, 0, 0));
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const Vec3 area = area_vector(mesh, mesh.facet(f));
        for (const Index v : mesh.facet(f)) sums[v] += area;
    });
    return sums;
}

/// Mean of a facet's corners.
inline Vec3 centroid(const PolygonMesh& mesh, std::span<const Index> facet) {
    Vec3 sum(0, 0, 0);
    for (Index v : facet) sum += mesh.positions[v];
    return sum / static_cast<double>(facet.size());
}

/// The direction of a vector; zero stays zero.
inline Vec3 unit(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? v / length : v;
}

/// The sine of a polygon's angle at corner i, with the unit normal it is seen along; negative if the corner
/// is reflex, 0 if it has a side without length.
inline double corner_sine(std::span<const Vec3> corners, std::size_t i, const Vec3& normal) {
    const Vec3 on = corners[(i + 1) % corners.size()] - corners[i];
    const Vec3 back = corners[(i + corners.size() - 1) % corners.size()] - corners[i];
    const double lengths = on.norm() * back.norm();
    return lengths > 0 ? (normal | (on % back)) / lengths : 0;
}

/// The least of a polygon's.
inline double least_corner_sine(std::span<const Vec3> corners) {
    const Vec3 normal = unit(area_vector(corners));
    double least = 1;
    for (std::size_t i = 0; i < corners.size(); ++i) least = std::min(least, corner_sine(corners, i, normal));
    return least;
}

} // namespace hsdm
