#include "hsdm/pipeline/finish_mesh.hh"

#include "hsdm/core/system.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/degenerate_facets.hh"

namespace hsdm {
namespace {

/// Phase 3: features and normals of the mesh.
void find_features(PolyMesh& mesh, const ReconstructOptions& options, const FeatureHints& hints,
                   Report& report) {
    FeatureOptions feature_options;
    feature_options.crease_angle = options.crease_angle;
    feature_options.write_normals = false; // smooth_normals writes them
    const FeatureCounts counts = classify_features(mesh, feature_options, hints);
    if (options.vertex_normals) {
        smooth_normals(mesh, {.rounds = options.normal_smoothing});
    }
    report.features.sharp_edges = counts.sharp_edges;
    report.features.smooth_vertices = counts.smooth_vertices;
    report.features.edge_vertices = counts.edge_vertices;
    report.features.corner_vertices = counts.corner_vertices;
}

void leave_out_unsound(const MethodInput& in, PolygonMesh& facets, FacetKnowledge& known, Report& report) {
    if (!known.links) known.links = link_facets(facets);
    Occurrences unsound =
        drop_degenerate_facets(facets, in.octree.origin, in.frame, *known.links, known.hints);
    report.rejected["facets_unsound"] = unsound.count;
    if (unsound.count == 0) return;
    known.cells.reset();
    unsound.first += in.octree.origin;
    note_dropped("facets that enclose nothing or have no area", unsound, in.frame, report);
}

/// Of what lies relative to the octree's origin.
void warn_of(const char* what, Occurrences relative, const MethodInput& in, Report& report) {
    relative.first += in.octree.origin;
    warn(what, relative, in.frame, report);
}

/// Lists the loops of the facets, and warns of them where none should be left.
void note_open_loops(const MethodInput& in, const PolygonMesh& facets, Report& report) {
    const bool closed = must_be_closed(in.options);
    if (!closed && report.mesh.boundary_loops == 0) return;
    const BoundaryLoops loops = boundary_loops(facets);
    if (in.options.measure) note_loops(facets, loops, false, in.octree.origin, in.frame, report);
    if (closed && loops.size() > 0)
        warn_of(warning_of::open_loops, {loops.size(), facets.positions[loops[0][0]]}, in, report);
}

/// Turns facets outward in the cloud's own coordinates: far from the origin these may have fewer digits than
/// those without the empty space. Returns how many were turned.
std::size_t face_outward(const CloudFrame& frame, PolygonMesh& facets, FacetKnowledge& known) {
    if (!frame.has_cuts()) return turn_outward(facets, *known.links, known.hints);
    std::vector<Vec3> positions = facets.positions;
    for (Vec3& p : facets.positions) p = frame.to_cloud(p) * (1 / frame.unit());
    const std::size_t turned = turn_outward(facets, *known.links, known.hints);
    facets.positions = std::move(positions);
    return turned;
}

} // namespace

void tell_in_cloud_units(const CloudFrame& frame, PolyMesh& mesh, Report& report) {
    if (frame.unit() == 1 && !frame.has_cuts()) return;
    for (const auto v : mesh.vertices()) mesh.set_point(v, frame.to_cloud(mesh.point(v)));
    report.input.bbox = frame.to_cloud(report.input.bbox);
    for (double* length : {&report.input.spacing, &report.grid.voxel_size, &report.grid.max_error,
                           &report.error.points_to_mesh_max, &report.error.points_to_mesh_mean,
                           &report.error.points_to_mesh_rms, &report.error.mesh_to_surface_max,
                           &report.error.mesh_to_surface_mean})
        *length *= frame.unit();
    for (Report::Loop& loop : report.loops) loop.length *= frame.unit();
}

void check_facets(const PolygonMesh& facets, const Report& report) {
    if (facets.facet_count() == 0)
        throw Error("no facet came out of " + std::to_string(report.grid.voxels) + " voxels at depth "
                    + std::to_string(report.grid.depth)
                    + "; try another depth, or check that the points sample a surface");
}

void finish_mesh(const MethodInput& in, PolygonMesh&& facets, FacetKnowledge&& known, Report&& report,
                 Reconstruction& result,
                 const std::function<void(PolygonMesh&, FacetKnowledge&, Report&)>& measure) {
    Report::Seconds& seconds = report.seconds;
    warn_of(warning_of::intersections, known.intersections, in, report);
    leave_out_unsound(in, facets, known, report);
    check_facets(facets, report);
    in.phases.run("error", 0.6, seconds.error, [&] { measure(facets, known, report); });
    note_open_loops(in, facets, report);
    in.phases.run("mesh", 0.85, seconds.mesh, [&] {
        if (!known.links) known.links = link_facets(facets);
        // this rounds positions; only then can be told how facets face
        for (Vec3& p : facets.positions) p += in.octree.origin;
        report.rejected["facets_turned"] = face_outward(in.frame, facets, known);
        const std::size_t rejected = to_mesh(facets, *known.links, result.mesh).rejected;
        report.rejected["to_mesh"] = rejected;
        if (rejected > 0) known.hints = {}; // hints are numbered by the sides of facets
    });
    if (in.options.classify)
        in.phases.run("features", 0.9, seconds.features,
                      [&] { find_features(result.mesh, in.options, known.hints, report); });
    tell_in_cloud_units(in.frame, result.mesh, report);
    report.peak_memory_bytes = os::peak_memory();
    result.report = std::move(report);
}

} // namespace hsdm
