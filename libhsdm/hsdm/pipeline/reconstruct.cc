#include "hsdm/reconstruct.hh"

#include "hsdm/core/system.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/pipeline/adaptive_grid.hh"
#include "hsdm/pipeline/basic_method.hh"
#include "hsdm/pipeline/confidence.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/prepared_cloud.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/degenerate_facets.hh"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <new>
#include <tuple>

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

/// Converts mesh and report from the stages' coordinates and units back to the cloud's.
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

/// Throws Error if there are none.
void check_facets(const PolygonMesh& facets, const OctreeLevel& level) {
    if (facets.facet_count() == 0)
        throw Error("no facet came out of " + std::to_string(level.size()) + " voxels at depth "
                    + std::to_string(level.depth)
                    + "; try another depth, or check that the points sample a surface");
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
    const bool closed = closes_all(in.options.holes) && in.options.trim == 0;
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

/// Phases 2 and 3 on one level of a prepared cloud; on the `last` level memory is freed as soon as it is no
/// longer needed.
void reconstruct_level(InputCloud& cloud, PreparedCloud& prepared, int depth, bool last,
                       const ReconstructOptions& options, const Phases& phases, Reconstruction& result) {
    const Octree& octree = prepared.octree;
    Report report = prepared.report;
    Report::Seconds& seconds = report.seconds;
    std::optional<NormalSets> sets;
    const OctreeLevel level =
        phases.run("voxels", 0.15, seconds.octree, [&] { return prepared.take_level(depth, sets); });
    report.grid.depth = depth;
    report.grid.voxel_size = level.voxel_size;
    report.grid.voxels = report.grid.sets = level.size();
    report.grid.leaves_per_level.assign(static_cast<std::size_t>(depth) + 1, 0);
    report.grid.leaves_per_level.back() = level.size();

    const MethodInput input{prepared.frame, *cloud, octree, level, options, phases, &sets};
    FacetKnowledge known;
    PolygonMesh facets = method_for(options) == Method::extended ? extended_method(input, report, known)
                                                                 : basic_method(input, report);
    if (options.trim > 0) trim_by_confidence(options.trim, input, facets, known, report);
    if (last) {
        prepared.release_normals();
        cloud.release_attributes();
    }
    check_facets(facets, level);
    std::vector<Vec3> as_read;
    if (prepared.has_moved() && (options.measure || wants_adaptive(options)))
        as_read = points_as_read(*cloud, prepared.frame, octree);
    if (last) cloud.release_positions();
    const std::span<const Vec3> points = prepared.has_moved() ? as_read : octree.positions;
    if (wants_adaptive(options)) {
        facets = phases.run("adaptive", 0.5, seconds.facets,
                            [&] { return adaptive_grid(input, points, facets, known, report); });
    }
    warn_of(warning_of::intersections, known.intersections, input, report);
    leave_out_unsound(input, facets, known, report);
    check_facets(facets, level);
    phases.run("error", 0.6, seconds.error, [&] { drop_and_measure(points, input, facets, known, report); });
    note_open_loops(input, facets, report);

    as_read = std::vector<Vec3>();
    phases.run("mesh", 0.85, seconds.mesh, [&] {
        if (!known.links) known.links = link_facets(facets);
        // this rounds positions; only then can be told how facets face
        for (Vec3& p : facets.positions) p += octree.origin;
        report.rejected["facets_turned"] = face_outward(prepared.frame, facets, known);
        const std::size_t rejected = to_mesh(facets, *known.links, result.mesh).rejected;
        report.rejected["to_mesh"] = rejected;
        if (rejected > 0) known.hints = {}; // hints are numbered by the sides of facets
    });
    if (options.classify)
        phases.run("features", 0.9, seconds.features,
                   [&] { find_features(result.mesh, options, known.hints, report); });
    tell_in_cloud_units(prepared.frame, result.mesh, report);
    report.peak_memory_bytes = os::peak_memory();
    result.report = std::move(report);
}

Reconstruction failed_level(const PreparedCloud& prepared, int depth, const std::exception& error,
                            const Phases& phases) {
    Reconstruction result;
    result.report = prepared.report;
    tell_in_cloud_units(prepared.frame, result.mesh, result.report);
    result.report.grid.depth = depth;
    result.report.failure = dynamic_cast<const std::bad_alloc*>(&error)
                                ? std::string("out of memory in phase ") + phases.current()
                                : error.what();
    return result;
}

/// One result per level of the range, or one of the level that the options choose.
void run(InputCloud& cloud, const ReconstructOptions& options, std::optional<std::pair<int, int>> range,
         std::span<Reconstruction> results) {
    const auto start = std::chrono::steady_clock::now();
    cloud.check();
    cloud.find_nonfinite_points();
    if (options.normals == NormalSource::given && !(*cloud).has_normals())
        throw Error("normals given were asked for, but the cloud has none");
    const bool estimate = must_estimate(*cloud, options); // before the octree takes the normals
    PreparedCloud prepared(cloud, options, Phases(options, 0, 1));
    Report& report = prepared.report;
    report.input.dropped_nonfinite = cloud.nonfinite().count;
    if (cloud.nonfinite().count > 0) report.input.first_nonfinite = cloud.nonfinite().first;
    report.threads = tbb::this_task_arena::max_concurrency();
    note_options(estimate, options, report);
    if (!(*cloud).sensors.empty()) report.options["sensors"] = std::to_string((*cloud).sensors.size());
    if (estimate)
        prepared.provide_normals(*cloud, Phases(options, 0, 1));
    else if (method_for(options) == Method::extended)
        prepared.check_given_normals(*cloud, Phases(options, 0, 1));
    if (!prepared.may_move()) cloud.release_positions();
    if (range) {
        report.options["levels"] = std::to_string(range->first) + ":" + std::to_string(range->second);
        report.options["resolution"] = "as asked by levels";
    } else {
        const int depth = Phases(options).run("resolution", 0.1, prepared.report.seconds.octree,
                                              [&] { return prepared.choose_resolution(options); });
        range = {depth, depth};
    }
    const auto count = static_cast<double>(results.size());
    std::size_t failures = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const double begin = static_cast<double>(i) / count;
        const Phases phases(options, begin, begin + 1 / count);
        const int depth = range->first + static_cast<int>(i);
        const auto level_start = i == 0 ? start : std::chrono::steady_clock::now();
        const bool last = i + 1 == results.size();
        try {
            prepared.smooth_for_depth(depth, phases);
            if (last && !prepared.has_moved()) cloud.release_positions();
            reconstruct_level(cloud, prepared, depth, last, options, phases, results[i]);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            if (++failures == results.size()) throw;
            results[i] = failed_level(prepared, depth, error, phases);
        }
        results[i].report.seconds.total =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - level_start).count();
    }
}

/// At most options.threads threads, for this call alone.
void run_in_arena(InputCloud& cloud, const ReconstructOptions& options,
                  std::optional<std::pair<int, int>> range, std::span<Reconstruction> results) {
    if (options.threads == 0) return run(cloud, options, range, results);
    // TBB prints a warning if more threads are asked for than are allowed.
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::task_arena arena(static_cast<int>(std::min(static_cast<std::size_t>(options.threads), allowed)));
    arena.execute([&] { run(cloud, options, range, results); });
}

Reconstruction run_once(InputCloud cloud, const ReconstructOptions& options) {
    check_options(options);
    Reconstruction result;
    run_in_arena(cloud, options, std::nullopt, {&result, 1});
    return result;
}

std::vector<Reconstruction> run_levels(InputCloud cloud, int first_depth, int last_depth,
                                       const ReconstructOptions& options) {
    check_options(options, first_depth, last_depth);
    std::vector<Reconstruction> results(static_cast<std::size_t>(last_depth - first_depth) + 1);
    run_in_arena(cloud, options, std::pair(first_depth, last_depth), results);
    return results;
}

} // namespace

Reconstruction reconstruct(const PointView& cloud, const ReconstructOptions& options) {
    return run_once(InputCloud(cloud), options);
}

Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options) {
    return run_once(InputCloud(view_of(cloud)), options);
}

Reconstruction reconstruct(PointCloud&& cloud, const ReconstructOptions& options) {
    return run_once(InputCloud(std::move(cloud)), options);
}

void note_reading(const PointFile& file, Report& report) {
    report.input.dropped_nonfinite += file.nonfinite;
    if (!file.columns.empty()) report.options["columns"] = file.columns;
    if (file.withheld > 0)
        report.dropped.insert(report.dropped.begin(),
                              {"points that the file marks as withheld", file.withheld, file.first_withheld});
}

Reconstruction reconstruct(PointFile&& file, const ReconstructOptions& options) {
    Reconstruction result = reconstruct(std::move(file.cloud), options);
    note_reading(file, result.report);
    return result;
}

std::vector<Reconstruction> reconstruct_levels(const PointView& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    return run_levels(InputCloud(cloud), first_depth, last_depth, options);
}

std::vector<Reconstruction> reconstruct_levels(const PointCloud& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    return run_levels(InputCloud(view_of(cloud)), first_depth, last_depth, options);
}

std::vector<Reconstruction> reconstruct_levels(PointCloud&& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    return run_levels(InputCloud(std::move(cloud)), first_depth, last_depth, options);
}

std::vector<Reconstruction> reconstruct_levels(PointFile&& file, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    std::vector<Reconstruction> results =
        reconstruct_levels(std::move(file.cloud), first_depth, last_depth, options);
    for (Reconstruction& result : results) note_reading(file, result.report);
    return results;
}

} // namespace hsdm
