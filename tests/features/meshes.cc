#include "features/meshes.hh"

#include <cmath>
#include <numbers>

namespace hsdm::test {

PolygonMesh capped_cylinder(Index m, Index n) {
    PolygonMesh mesh = support::quad_tube(m, n, [=](Index j, Index i) {
        const double angle = 2 * std::numbers::pi * j / m;
        return Vec3(std::cos(angle), std::sin(angle), 2.0 * i / n - 1);
    });
    const Index bottom = (n + 1) * m, top = bottom + 1;
    mesh.positions.emplace_back(0, 0, -1);
    mesh.positions.emplace_back(0, 0, 1);
    for (Index j = 0; j < m; ++j) {
        const Index k = (j + 1) % m;
        mesh.add_facet(std::vector<Index>{k, j, bottom});
        mesh.add_facet(std::vector<Index>{n * m + j, n * m + k, top});
    }
    return mesh;
}

PolygonMesh noisy(PolygonMesh mesh, double sigma) {
    support::Random random(7);
    for (Vec3& p : mesh.positions) p += sigma * random.gauss3();
    return mesh;
}

} // namespace hsdm::test
