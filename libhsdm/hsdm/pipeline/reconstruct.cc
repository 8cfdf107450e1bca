#include "hsdm/reconstruct.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/islands.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/pipeline/adaptive_grid.hh"
#include "hsdm/pipeline/decomposition.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/quality/drop_unsound.hh"
#include "hsdm/quality/topology.hh"

#include <tbb/global_control.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <new>
#include <numbers>
#include <sys/resource.h>
#include <tuple>

namespace hsdm {
namespace {

constexpr std::size_t points_per_chunk = 1 << 14;

void check_depth(const std::string& name, int depth) {
    if (depth < 1 || depth > deepest_level)
        throw OptionError(name + " " + std::to_string(depth) + ": must lie in [1, "
                          + std::to_string(deepest_level) + "]");
}

/// The extended method is the better one, with normals given or estimated.
Method method_for(const ReconstructOptions& options) {
    return options.method == Method::basic ? Method::basic : Method::extended;
}

bool must_estimate(const PointCloud& cloud, const ReconstructOptions& options) {
    if (method_for(options) == Method::basic) return false;
    return options.normals == NormalSource::estimate || !cloud.has_normals();
}

std::string name_of(Holes holes) {
    return holes == Holes::keep ? "keep" : holes == Holes::close ? "close" : "auto";
}

void note_options(bool estimate, const ReconstructOptions& options, Report& report) {
    const bool extended = method_for(options) == Method::extended;
    report.options["method"] = extended ? "extended" : "basic";
    report.options["normals"] = estimate ? "estimate" : extended ? "given" : "none";
    report.options["grid"] = wants_adaptive(options) ? "adaptive" : "uniform";
    if (options.max_error)
        report.options["max-error"] = options.max_error->of_diagonal
                                          ? text_of(100 * options.max_error->value) + "%"
                                          : text_of(options.max_error->value);
    report.options["holes"] = name_of(options.holes);
    if (options.merge_layers) report.options["merge-layers"] = "yes";
    if (options.min_component)
        report.options["min-component"] = options.min_component->of_largest
                                              ? text_of(100 * options.min_component->value) + "%"
                                              : text_of(options.min_component->value);
    report.options["crease-degrees"] = text_of(options.crease_angle * 180 / std::numbers::pi);
    report.options["smoothing"] = std::to_string(options.normal_smoothing);
}

void note_islands(const Islands& islands, Report& report) {
    report.rejected["components_small"] = islands.components;
    report.rejected["facets_of_small_components"] = islands.facets.count;
}

void measure_mesh(const PolygonMesh& facets, Report& report) {
    const Topology t = measure_connectivity(facets);
    Report::Mesh& m = report.mesh;
    m.vertices = t.vertices;
    m.edges = t.edges;
    m.faces = t.faces;
    m.triangles = t.triangles;
    m.quads = t.quads;
    m.larger = t.larger;
    m.components = t.components;
    m.boundary_loops = t.boundary_loops;
    m.boundary_edges = t.boundary_edges;
    m.euler = t.euler;
    m.genus = t.genus();
    m.closed = t.closed();
}

/// The octree's points where the cloud has them, relative to its origin.
std::vector<Vec3> points_as_read(const PointCloud& cloud, const CloudFrame& frame, const Octree& octree) {
    std::vector<Vec3> points(octree.size());
    for_chunks(points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            points[i] = frame.to_work(cloud.positions[octree.source[i]]) - octree.origin;
    });
    return points;
}

/// Returns the points whose voxel no facet came out of. A vertex lies in its voxel or beside it: farther from
/// the mesh than from one end of the voxel to the other no point is that has one.
Discarded measure_error(std::span<const Vec3> points, const Octree& octree, const PolygonMesh& facets,
                        FacetKnowledge& known, double enough, Report& report) {
    const bool by_cells = report.grid.kind == "uniform"; // facets are as large as voxels
    const double diagonal = std::numbers::sqrt3 * report.grid.voxel_size;
    if (by_cells && !known.cells) known.cells.emplace(facets, report.grid.voxel_size);
    const Distance distance =
        by_cells ? points_to_mesh_by_cells(points, facets, *known.cells, diagonal)
                 : points_to_mesh(points, facets, {.enough = enough, .beyond = std::max(diagonal, enough)});
    report.error.points_to_mesh_max = distance.max;
    report.error.points_to_mesh_mean = distance.mean;
    report.error.points_to_mesh_rms = distance.rms;
    report.error.normalised_max = distance.max / octree.bounds.diagonal();
    if (distance.beyond == 0) return {};
    return {distance.beyond, points[distance.first_beyond] + octree.origin};
}

/// Drops small components if asked to, and measures what is left. A bound is checked before: it is one for
/// the points of what is dropped too.
void drop_and_measure(std::span<const Vec3> points, const MethodInput& in, PolygonMesh& facets,
                      FacetKnowledge& known, Report& report) {
    const Octree& octree = in.octree; // no structured bindings: clang 14 cannot capture them
    const ReconstructOptions& options = in.options;
    bool measured = report.grid.max_error > 0;
    Discarded off;
    if (measured)
        off =
            measure_error(points, octree, facets, known, options.measure ? 0 : report.grid.max_error, report);
    check_error_kept(report, in.frame.unit());
    if (options.min_component) {
        const auto [value, of_largest] = *options.min_component;
        Islands islands = drop_islands(facets, known.hints, {of_largest ? 0 : value, of_largest ? value : 0});
        note_islands(islands, report);
        islands.facets.first += octree.origin;
        note_dropped("facets of components smaller than asked for", islands.facets, in.frame, report);
        if (islands.components > 0) {
            known.links.reset();
            known.cells.reset();
            measured = false;
        }
    }
    if (!options.measure) {
        report.error = {};
        return;
    }
    tbb::parallel_invoke(
        [&] {
            if (!measured) off = measure_error(points, octree, facets, known, 0, report);
        },
        [&] { measure_mesh(facets, report); });
    note_dropped("points more than a voxel's diagonal off the mesh", off, in.frame, report);
}

/// Phase 3 on the mesh.
void find_features(PolyMesh& mesh, const ReconstructOptions& options, const FeatureHints& hints,
                   Report& report) {
    FeatureOptions feature_options;
    feature_options.crease_angle = options.crease_angle;
    feature_options.write_normals = false; // smooth_normals does
    const FeatureCounts counts = classify_features(mesh, feature_options, hints);
    if (options.vertex_normals) {
        NormalSmoothingOptions smoothing;
        smoothing.rounds = options.normal_smoothing;
        smooth_normals(mesh, smoothing);
    }
    report.features.sharp_edges = counts.sharp_edges;
    report.features.smooth_vertices = counts.smooth_vertices;
    report.features.edge_vertices = counts.edge_vertices;
    report.features.corner_vertices = counts.corner_vertices;
}

/// What the stages made and measured goes back into the cloud's own coordinates and units.
void tell_in_cloud_units(const CloudFrame& frame, PolyMesh& mesh, Report& report) {
    if (frame.unit() == 1 && !frame.has_cuts()) return;
    for (const auto v : mesh.vertices()) mesh.set_point(v, frame.to_cloud(mesh.point(v)));
    report.input.bbox = frame.to_cloud(report.input.bbox);
    for (double* length : {&report.input.spacing, &report.grid.voxel_size, &report.grid.max_error,
                           &report.error.points_to_mesh_max, &report.error.points_to_mesh_mean,
                           &report.error.points_to_mesh_rms, &report.error.mesh_to_surface_max,
                           &report.error.mesh_to_surface_mean})
        *length *= frame.unit();
}

/// Peak of the whole process so far; the kernel counts in KiB.
std::size_t peak_memory() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
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
    Discarded unsound = drop_unsound(facets, in.octree.origin, in.frame, *known.links, known.hints);
    report.rejected["facets_unsound"] = unsound.count;
    if (unsound.count == 0) return;
    known.cells.reset();
    unsound.first += in.octree.origin;
    note_dropped("facets that enclose nothing or have no area", unsound, in.frame, report);
}

/// Far from the origin the cloud's own coordinates may have fewer digits than those without the empty space:
/// how facets face is asked where they will stand. Returns how many were turned.
std::size_t face_outward(const CloudFrame& frame, PolygonMesh& facets, FacetKnowledge& known) {
    if (!frame.has_cuts()) return turn_outward(facets, *known.links, known.hints);
    std::vector<Vec3> positions = facets.positions;
    for (Vec3& p : facets.positions) p = frame.to_cloud(p) * (1 / frame.unit());
    const std::size_t turned = turn_outward(facets, *known.links, known.hints);
    facets.positions = std::move(positions);
    return turned;
}

/// Phases 2 and 3 on one level of a decomposition; on the `last` one what is not needed any more is let go.
void reconstruct_level(InputCloud& cloud, Decomposition& decomposition, int depth, bool last,
                       const ReconstructOptions& options, const Phases& phases, Reconstruction& result) {
    const Octree& octree = decomposition.octree;
    Report report = decomposition.report;
    Report::Seconds& seconds = report.seconds;
    const OctreeLevel level =
        phases.run("voxels", 0.15, seconds.octree, [&] { return extract_level(octree, depth); });
    report.grid.depth = depth;
    report.grid.voxel_size = level.voxel_size;
    report.grid.voxels = report.grid.sets = level.size();
    report.grid.leaves_per_level.assign(static_cast<std::size_t>(depth) + 1, 0);
    report.grid.leaves_per_level.back() = level.size();

    const MethodInput input{decomposition.frame, *cloud, octree, level, options, phases};
    FacetKnowledge known;
    PolygonMesh facets = method_for(options) == Method::extended ? extended_method(input, report, known)
                                                                 : basic_method(input, report);
    if (last) {
        decomposition.release_normals();
        cloud.release_attributes();
    }
    check_facets(facets, level);
    std::vector<Vec3> as_read;
    if (decomposition.has_moved() && (options.measure || wants_adaptive(options)))
        as_read = points_as_read(*cloud, decomposition.frame, octree);
    if (last) cloud.release_positions();
    const std::span<const Vec3> points = decomposition.has_moved() ? as_read : octree.positions;
    if (wants_adaptive(options)) {
        facets = phases.run("adaptive", 0.5, seconds.facets, [&] {
            return adaptive_grid(input, points, facets, known.cells ? &*known.cells : nullptr, report);
        });
        known = {}; // of the fine facets
    }
    leave_out_unsound(input, facets, known, report);
    check_facets(facets, level);
    phases.run("error", 0.6, seconds.error, [&] { drop_and_measure(points, input, facets, known, report); });

    as_read = std::vector<Vec3>();
    phases.run("mesh", 0.85, seconds.mesh, [&] {
        if (!known.links) known.links = link_facets(facets);
        for (Vec3& p : facets.positions) p += octree.origin; // rounded there; a side is what it is then
        report.rejected["facets_turned"] = face_outward(decomposition.frame, facets, known);
        const std::size_t rejected = to_mesh(facets, *known.links, result.mesh).rejected;
        report.rejected["to_mesh"] = rejected;
        if (rejected > 0) known.hints = {}; // they are counted by facets
    });
    if (options.classify)
        phases.run("features", 0.9, seconds.features,
                   [&] { find_features(result.mesh, options, known.hints, report); });
    tell_in_cloud_units(decomposition.frame, result.mesh, report);
    report.peak_memory_bytes = peak_memory();
    result.report = std::move(report);
}

Reconstruction failed_level(const Decomposition& decomposition, int depth, const std::exception& error,
                            const Phases& phases) {
    Reconstruction result;
    result.report = decomposition.report;
    tell_in_cloud_units(decomposition.frame, result.mesh, result.report);
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
    cloud.drop_nonfinite_points();
    if (options.normals == NormalSource::given && !(*cloud).has_normals())
        throw Error("normals given were asked for, but the cloud has none");
    const bool estimate = must_estimate(*cloud, options); // before the octree takes the normals
    Decomposition decomposition(cloud, options, Phases(options, 0, 1));
    Report& report = decomposition.report;
    report.input.dropped_nonfinite = cloud.dropped().nonfinite;
    if (cloud.dropped().nonfinite > 0) report.input.first_nonfinite = cloud.dropped().first_nonfinite;
    report.threads = tbb::this_task_arena::max_concurrency();
    note_options(estimate, options, report);
    if (estimate)
        decomposition.provide_normals(*cloud, Phases(options, 0, 1));
    else if (method_for(options) == Method::extended)
        decomposition.check_given_normals(*cloud, Phases(options, 0, 1));
    if (!decomposition.may_move()) cloud.release_positions();
    if (range) {
        report.options["levels"] = std::to_string(range->first) + ":" + std::to_string(range->second);
        report.options["resolution"] = "as asked by levels";
    } else {
        const int depth = decomposition.choose_resolution(options);
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
            decomposition.smooth_for_depth(depth, phases);
            if (last && !decomposition.has_moved()) cloud.release_positions();
            reconstruct_level(cloud, decomposition, depth, last, options, phases, results[i]);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            if (++failures == results.size()) throw;
            results[i] = failed_level(decomposition, depth, error, phases);
        }
        results[i].report.seconds.total =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - level_start).count();
    }
}

/// At most options.threads threads, for this call alone.
void run_in_arena(InputCloud& cloud, const ReconstructOptions& options,
                  std::optional<std::pair<int, int>> range, std::span<Reconstruction> results) {
    if (options.threads == 0) return run(cloud, options, range, results);
    // More than may run would be a warning that TBB prints.
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

void check_options(const ReconstructOptions& o) {
    if (!!o.depth + !!o.voxel_size + !!o.max_error > 1)
        throw OptionError("depth, voxel_size and max_error: at most one of the three says the resolution");
    if (o.max_error && !(o.max_error->value > 0 && std::isfinite(o.max_error->value)))
        throw OptionError("max_error " + text_of(o.max_error->value) + ": must be above 0");
    if (o.max_error && o.grid == Grid::uniform)
        throw OptionError("max_error: a uniform grid has no bound to keep; use the adaptive one");
    if (o.depth) check_depth("depth", *o.depth);
    if (o.voxel_size && !(*o.voxel_size > 0 && std::isfinite(*o.voxel_size)))
        throw OptionError("voxel_size " + text_of(*o.voxel_size) + ": must be a length above 0");
    if (o.min_component
        && !(o.min_component->value >= 0 && std::isfinite(o.min_component->value)
             && !(o.min_component->of_largest && o.min_component->value > 1)))
        throw OptionError("min_component " + text_of(o.min_component->value)
                          + ": must be a number of facets, or a share of the largest of 1 (100 %) at most");
    if (!(o.crease_angle > 0 && o.crease_angle < std::numbers::pi))
        throw OptionError("crease_angle " + text_of(o.crease_angle)
                          + " rad: must lie between 0 and pi (180 degrees)");
    if (o.normal_smoothing < 0)
        throw OptionError("normal_smoothing " + std::to_string(o.normal_smoothing) + ": must be 0 or more");
    if (o.threads < 0)
        throw OptionError("threads " + std::to_string(o.threads) + ": must be 0 (all) or more");
    if (o.normals == NormalSource::estimate && o.method == Method::basic)
        throw OptionError("normals estimate: the basic method uses no normals; use the extended one");
}

void check_options(const ReconstructOptions& options, int first_depth, int last_depth) {
    check_options(options);
    if (options.depth || options.voxel_size || options.max_error)
        throw OptionError(
            "levels: they are the resolution; depth, voxel_size and max_error cannot be given beside them");
    check_depth("first depth", first_depth);
    check_depth("last depth", last_depth);
    if (first_depth > last_depth)
        throw OptionError("levels " + std::to_string(first_depth) + ":" + std::to_string(last_depth)
                          + ": the first depth must not be above the last");
}

Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options) {
    return run_once(InputCloud(cloud), options);
}

Reconstruction reconstruct(PointCloud&& cloud, const ReconstructOptions& options) {
    return run_once(InputCloud(std::move(cloud)), options);
}

std::vector<Reconstruction> reconstruct_levels(const PointCloud& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    return run_levels(InputCloud(cloud), first_depth, last_depth, options);
}

std::vector<Reconstruction> reconstruct_levels(PointCloud&& cloud, int first_depth, int last_depth,
                                               const ReconstructOptions& options) {
    return run_levels(InputCloud(std::move(cloud)), first_depth, last_depth, options);
}

} // namespace hsdm
