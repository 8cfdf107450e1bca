#include "hsdm/simplify/mesh_checks.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/mesh/part_of.hh"

namespace hsdm {

MeshChecks::MeshChecks(const PolygonMesh& fine, const FacetCells* cells, std::span<const Vec3> points,
                       double bound, double spacing, double tolerance)
    : distances_(fine, cells, points, bound, spacing), envelope_{distances_.to_fine(), tolerance} {}

Unchanged MeshChecks::compare_with_last(const PolygonMesh& mesh) {
    Unchanged same = find_unchanged(last_, mesh);
    last_ = copy_of(mesh);
    return same;
}

/// Both at once, because each has steps that run on one thread.
Findings MeshChecks::look_at(const PolygonMesh& mesh) {
    const Unchanged same = compare_with_last(mesh);
    Findings found;
    run_both(
        [&] {
            found.far = distances_.find_far(mesh, same);
            found.far_points = distances_.find_far_points();
        },
        [&] { found.intersecting = intersections_.find(mesh, same); });
    return found;
}

FarPoints MeshChecks::far_points(const PolygonMesh& mesh) {
    distances_.set_mesh(mesh, compare_with_last(mesh));
    return distances_.find_far_points();
}

} // namespace hsdm
