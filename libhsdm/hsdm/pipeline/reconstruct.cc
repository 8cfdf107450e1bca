#include "hsdm/reconstruct.hh"

#include "hsdm/core/system.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/pipeline/adaptive_grid.hh"
#include "hsdm/pipeline/basic_method.hh"
#include "hsdm/pipeline/confidence.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/pipeline/finish_mesh.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/prepared_cloud.hh"
#include "hsdm/pipeline/sparse_areas.hh"
#include "hsdm/pipeline/warnings.hh"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <new>
#include <tuple>

namespace hsdm {
namespace {

/// Warns of voxels that were asked for where they are too small for the points; if not, coarser ones help.
void warn_of_small_voxels(const OctreeLevel& level, const PreparedCloud& prepared,
                          const ReconstructOptions& options, Report& report) {
    if (!are_voxels_asked_for(options, report)) return;
    Occurrences small = voxels_too_small(level);
    small.first += prepared.octree.origin;
    warn(warning_of::too_small, small, prepared.frame, report);
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
    if (last) {
        prepared.release_codes();
        prepared.release_sources(*cloud);
    }
    report.grid.depth = depth;
    report.grid.voxel_size = level.voxel_size;
    report.grid.voxels = report.grid.sets = level.size();
    report.grid.leaves_per_level.assign(static_cast<std::size_t>(depth) + 1, 0);
    report.grid.leaves_per_level.back() = level.size();

    warn_of_small_voxels(level, prepared, options, report);
    MethodInput input{prepared.frame, *cloud, octree, level,
                      options,        phases, &sets,  prepared.viewpoints_of(*cloud)};
    input.has_layers = prepared.has_layers();
    FacetKnowledge known;
    PolygonMesh facets = method_for(options) == Method::extended ? extended_method(input, report, known)
                                                                 : basic_method(input, report);
    if (options.trim > 0) trim_by_confidence(options.trim, input, facets, known, report);
    if (last) {
        prepared.release_normals();
        cloud.release_attributes();
    }
    check_facets(facets, report);
    std::vector<Vec3> as_read;
    if (prepared.has_moved() && (options.measure || wants_adaptive(options)))
        as_read = points_as_read(*cloud, prepared.frame, octree);
    if (last) cloud.release_positions();
    const std::span<const Vec3> points = prepared.has_moved() ? as_read : octree.positions;
    if (wants_adaptive(options)) {
        facets = phases.run("adaptive", 0.5, seconds.facets,
                            [&] { return adaptive_grid(input, points, facets, known, report); });
    }
    finish_mesh(input, std::move(facets), std::move(known), std::move(report), result,
                [&](PolygonMesh& mesh, FacetKnowledge& what, Report& of) {
                    drop_and_measure(points, input, mesh, what, of);
                    as_read = std::vector<Vec3>();
                });
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
    note_left_out(file.partial, report);
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
