#include "hsdm/simplify/mesh_checks.hh"

#include <tbb/parallel_invoke.h>

namespace hsdm {

MeshChecks::MeshChecks(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                       double bound, double spacing, double tolerance)
    : bound_(fine, cells, points, bound, spacing),
      envelope_(bound_.to_fine(), tolerance, 2 * fine.vertex_count()) {}

/// The two in parallel, because each has steps that run on one thread.
Findings MeshChecks::look_at(const PolygonMesh& mesh) {
    Findings found;
    tbb::parallel_invoke([&] { found.intersecting = intersections_.find(mesh); },
                         [&] {
                             found.far = bound_.find_far(mesh);
                             found.far_points = bound_.find_far_points();
                         });
    return found;
}

FarPoints MeshChecks::far_points(const PolygonMesh& mesh) {
    bound_.find_far(mesh);
    return bound_.find_far_points();
}

} // namespace hsdm
