#include "hsdm/pipeline/adaptive_grid.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/flat_facets.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/constants.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/simplify/simplify.hh"

#include <cstdio>

namespace hsdm {
namespace {

double error_bound(const MethodInput& in) {
    if (!in.options.max_error) return sheets::plane_error * in.level.voxel_size;
    const MaxError& asked = *in.options.max_error;
    return asked.of_diagonal ? asked.value * in.octree.bounds.diagonal() : asked.value / in.frame.unit();
}

/// Properties of the coarse vertices, merged from those of the fine vertices that they stand for; levels are
/// their own.
std::vector<VertexProperty> properties_of(const PolygonMesh& fine, const AdaptiveMesh& coarse) {
    std::vector<VertexProperty> result =
        merge_attributes(fine.properties, coarse.vertex, coarse.mesh.vertex_count());
    for (VertexProperty& property : result)
        if (property.name == level_property) property.values.assign(coarse.level.begin(), coarse.level.end());
    return result;
}

} // namespace

PolygonMesh adaptive_grid(const MethodInput& in, std::span<const Vec3> points, const PolygonMesh& fine,
                          FacetKnowledge& known, Report& report) {
    const double bound = error_bound(in);
    AdaptiveMesh coarse =
        simplify(fine, points, in.octree.extent, in.level.depth,
                 {.max_error = bound, .measure = in.options.measure}, known.cells ? &*known.cells : nullptr);
    known = {};
    unite_flat_facets(in.octree.origin, coarse.mesh);
    if (coarse.intersecting > 0) known.intersections = facets_that_meet(coarse.mesh);
    report.rejected["intersections_left"] = coarse.intersecting;
    report.grid.kind = "adaptive";
    report.grid.leaves_per_level = coarse.leaves_per_level;
    report.grid.balance_splits = coarse.balance_splits;
    report.grid.merged = coarse.merged;
    report.grid.max_error = bound;
    report.grid.points_beyond = coarse.unreachable;
    if (in.options.max_error && coarse.unreachable > 0)
        warn(warning_of::beyond, {coarse.unreachable, points[coarse.first_unreachable] + in.octree.origin},
             in.frame, report);
    report.rejected["leaves_split_for_topology"] = coarse.topology_splits;
    report.rejected["leaves_split_for_error"] = coarse.error_splits;
    report.rejected["leaves_split_for_intersections"] = coarse.intersection_splits;
    report.error.mesh_to_surface_max = coarse.to_fine.max;
    report.error.mesh_to_surface_mean = coarse.to_fine.mean;
    coarse.mesh.properties = properties_of(fine, coarse);
    return std::move(coarse.mesh);
}

void check_error_kept(const Report& report, double unit) {
    if (report.grid.max_error == 0 || report.grid.points_beyond > 0) return;
    if (report.error.points_to_mesh_max <= report.grid.max_error) return;
    char text[160];
    std::snprintf(text, sizeof text,
                  "max_error %.6g: not kept, a point is %.6g from the mesh; ask for a larger one, or for a "
                  "uniform grid",
                  report.grid.max_error * unit, report.error.points_to_mesh_max * unit);
    throw Error(text);
}

} // namespace hsdm
