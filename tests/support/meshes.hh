#pragma once
// Small meshes, written out or over grids.

#include "hsdm/polygon_mesh.hh"

#include <array>

namespace hsdm::support {

PolygonMesh mesh_of(std::vector<Vec3> positions, const std::vector<std::vector<Index>>& facets);

/// Corners of the unit cube: corner x + 2 y + 4 z at (x, y, z).
std::vector<Vec3> cube_corners();
/// Six quads, outward.
PolygonMesh unit_cube();
/// Three edges of length `size` along the axes; outward.
PolygonMesh tetrahedron(double size = 1);
/// The cube [-1, 1]^3, n x n quads on each side, vertices shared along its edges; outward.
PolygonMesh divided_cube(Index n);
/// That cube blown up to the unit sphere.
PolygonMesh divided_sphere(Index n);

/// columns x rows quads, vertices `at(column, row)` row by row; upward if columns lead along x and rows along
/// y.
template <class At>
PolygonMesh quad_sheet(Index columns, Index rows, const At& at) {
    PolygonMesh mesh;
    for (Index r = 0; r <= rows; ++r)
        for (Index c = 0; c <= columns; ++c) mesh.positions.push_back(at(c, r));
    for (Index r = 0; r < rows; ++r)
        for (Index c = 0; c < columns; ++c) {
            const Index v = r * (columns + 1) + c;
            mesh.add_facet(std::array{v, v + 1, v + columns + 2, v + columns + 1});
        }
    return mesh;
}

/// Open at both ends: the same, with the last column joined to the first.
template <class At>
PolygonMesh quad_tube(Index around, Index rows, const At& at) {
    PolygonMesh mesh;
    for (Index r = 0; r <= rows; ++r)
        for (Index c = 0; c < around; ++c) mesh.positions.push_back(at(c, r));
    for (Index r = 0; r < rows; ++r)
        for (Index c = 0; c < around; ++c) {
            const Index row = r * around, next = (c + 1) % around;
            mesh.add_facet(std::array{row + c, row + next, row + around + next, row + around + c});
        }
    return mesh;
}

/// A tube of quads about the z axis, open at both ends: rings `step` apart, the first at z = 0; outward.
PolygonMesh round_tube(Index around, Index rows, double radius, double step);

/// Every quad cut from its first corner.
PolygonMesh cut_in_two(const PolygonMesh& quads);

} // namespace hsdm::support
