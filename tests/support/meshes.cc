#include "support/meshes.hh"

#include <cmath>
#include <map>
#include <numbers>

namespace hsdm::support {

PolygonMesh mesh_of(std::vector<Vec3> positions, const std::vector<std::vector<Index>>& facets) {
    PolygonMesh mesh;
    mesh.positions = std::move(positions);
    for (const auto& facet : facets) mesh.add_facet(facet);
    return mesh;
}

std::vector<Vec3> cube_corners() {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    return corners;
}

PolygonMesh unit_cube() {
    return mesh_of(cube_corners(),
                   {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

PolygonMesh tetrahedron(double size) {
    return mesh_of({{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

PolygonMesh divided_cube(Index n) {
    PolygonMesh mesh;
    std::map<std::array<Index, 3>, Index> number;
    const auto vertex = [&](std::array<Index, 3> at) {
        const auto [it, added] = number.try_emplace(at, static_cast<Index>(mesh.positions.size()));
        if (added) mesh.positions.emplace_back(2.0 * at[0] / n - 1, 2.0 * at[1] / n - 1, 2.0 * at[2] / n - 1);
        return it->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Index side : {Index{0}, n})
            for (Index a = 0; a < n; ++a)
                for (Index b = 0; b < n; ++b) {
                    const auto corner = [&](Index u, Index v) {
                        std::array<Index, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = a + (side ? u : v); // the other side turns the other way
                        at[(axis + 2) % 3] = b + (side ? v : u);
                        return vertex(at);
                    };
                    mesh.add_facet(std::array{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
                }
    return mesh;
}

PolygonMesh divided_sphere(Index n) {
    PolygonMesh mesh = divided_cube(n);
    for (Vec3& p : mesh.positions) p.normalize();
    return mesh;
}

PolygonMesh round_tube(Index around, Index rows, double radius, double step) {
    return quad_tube(around, rows, [=](Index c, Index r) {
        const double turn = 2 * std::numbers::pi * c / around;
        return Vec3(radius * std::cos(turn), radius * std::sin(turn), step * r);
    });
}

PolygonMesh cut_in_two(const PolygonMesh& quads) {
    PolygonMesh cut;
    cut.positions = quads.positions;
    for (std::size_t f = 0; f < quads.facet_count(); ++f) {
        const auto q = quads.facet(f);
        cut.add_facet(std::array{q[0], q[1], q[2]});
        cut.add_facet(std::array{q[0], q[2], q[3]});
    }
    return cut;
}

} // namespace hsdm::support
