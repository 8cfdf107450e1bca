#include "features/meshes.hh"

#include <cmath>
#include <map>
#include <numbers>

namespace hsdm::test {

PolygonMesh cube(Index n) {
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
                    mesh.add_facet(
                        std::vector<Index>{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
                }
    return mesh;
}

PolygonMesh capped_cylinder(Index m, Index n) {
    PolygonMesh mesh;
    for (Index i = 0; i <= n; ++i)
        for (Index j = 0; j < m; ++j) {
            const double angle = 2 * std::numbers::pi * j / m;
            mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 2.0 * i / n - 1);
        }
    const Index bottom = (n + 1) * m, top = bottom + 1;
    mesh.positions.emplace_back(0, 0, -1);
    mesh.positions.emplace_back(0, 0, 1);
    for (Index j = 0; j < m; ++j) {
        const Index k = (j + 1) % m;
        for (Index i = 0; i < n; ++i)
            mesh.add_facet(std::vector<Index>{i * m + j, i * m + k, (i + 1) * m + k, (i + 1) * m + j});
        mesh.add_facet(std::vector<Index>{k, j, bottom});
        mesh.add_facet(std::vector<Index>{n * m + j, n * m + k, top});
    }
    return mesh;
}

PolygonMesh sphere(Index n) {
    PolygonMesh mesh = cube(n);
    for (Vec3& p : mesh.positions) p.normalize();
    return mesh;
}

PolygonMesh noisy(PolygonMesh mesh, double sigma) {
    support::Random random(7);
    for (Vec3& p : mesh.positions) p += sigma * random.gauss3();
    return mesh;
}

} // namespace hsdm::test
