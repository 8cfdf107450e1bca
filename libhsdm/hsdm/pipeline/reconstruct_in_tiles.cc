#include "hsdm/pipeline/reconstruct_in_tiles.hh"

#include "hsdm/errors.hh"
#include "hsdm/pipeline/make_tiles.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/tile_plan.hh"
#include "hsdm/pipeline/whole_of_tiles.hh"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <optional>

namespace hsdm {
namespace {

/// So many points, with what is made of them, fit what is left of the memory.
std::size_t points_at_once(const TileOptions& tiles, std::size_t bytes_of_mesh) {
    if (tiles.most_points > 0) return tiles.most_points;
    constexpr std::size_t fewest = std::size_t{1} << 18; // some tens of megabytes
    const std::size_t used = bytes_of_program + bytes_of_mesh;
    return std::max(fewest, used < tiles.memory ? (tiles.memory - used) / bytes_per_point : 0);
}

/// A tile may have what its own facets and those of all tiles will leave.
std::size_t points_of_tile(const TileOptions& tiles, std::size_t voxels) {
    if (tiles.most_points > 0) return tiles.most_points;
    const std::size_t mesh = voxels * bytes_per_voxel_of_pieces;
    const std::size_t finished = voxels * bytes_per_voxel_of_mesh + bytes_of_program;
    if (finished > tiles.memory)
        throw Error("the mesh of " + std::to_string(voxels) + " voxels takes about "
                    + std::to_string(finished / 1000000)
                    + " MB, which is held in memory; give --memory that much, or a smaller --depth");
    return (tiles.memory - std::min(tiles.memory, mesh + bytes_of_program)) / bytes_per_point;
}

/// What is known of the cloud, once tiles have been made.
void note_cloud(const ScratchCloud& cloud, const CloudSurvey& survey, std::size_t duplicates,
                const TilesKnown& known, Report& report) {
    const CloudExtent& extent = cloud.extent();
    const std::size_t outliers = cloud.left_out().size(), voxels = survey.sums.voxels();
    report.input.points = extent.finite();
    report.input.dropped_nonfinite = extent.nonfinite;
    if (extent.nonfinite > 0) report.input.first_nonfinite = extent.first_nonfinite;
    report.input.merged_duplicates = duplicates;
    report.input.has_normals = true;
    report.input.bbox = extent.box;
    report.input.spacing = survey.spacing;
    report.grid.depth = cloud.depth();
    report.grid.voxel_size = cloud.voxel_size();
    report.grid.voxels = voxels;
    report.grid.leaves_per_level.assign(static_cast<std::size_t>(cloud.depth()) + 1, 0);
    report.grid.leaves_per_level.back() = voxels;
    report.rejected["normals_mended"] = 0;
    report.rejected["points_outlying"] = outliers;
    note_dropped("points off every surface", {outliers, known.first_outlier + cloud.origin()}, cloud.frame(),
                 report);
}

/// The facets of all tiles; once more if normals point into the solid, as what is judged depends on the side.
WholeFacets facets_of_tiles(const TilesInput& in, const TileOptions& tiles, std::size_t duplicates,
                            Report& report, TileReport& how) {
    const std::vector<VoxelRange> ranges =
        plan_tiles(in.cloud.cells(), {in.cloud.depth(), in.cloud.cell_depth(), tiles.ghost_voxels,
                                      points_of_tile(tiles, in.survey.sums.voxels())});
    how.tiles = ranges.size();
    TilesKnown known;
    WholeFacets whole = join_tiles(make_tiles(in, ranges, false, known, how));
    const bool turned = faces_inward(whole.mesh);
    if (turned) {
        whole = WholeFacets();
        whole = join_tiles(make_tiles(in, ranges, true, known, how));
    }
    report.grid.sets = whole.counts.sets;
    report.rejected["normals_turned"] = turned ? in.survey.sums.points() : 0;
    note_cloud(in.cloud, in.survey, duplicates, known, report);
    return whole;
}

Reconstruction run_tiles(const PointParts& parts, const ReconstructOptions& options, const TileOptions& tiles,
                         TileReport& how) {
    const auto start = std::chrono::steady_clock::now();
    const Phases phases(options);
    Report report;
    report.threads = tbb::this_task_arena::max_concurrency();
    note_options(false, options, report);
    report.options["depth"] = std::to_string(*options.depth);
    report.options["resolution"] = "as asked by depth";
    std::optional<ScratchCloud> cloud;
    phases.run("octree", 0, report.seconds.octree,
               [&] { cloud.emplace(parts, measure_extent(parts), *options.depth, tiles); });
    const std::size_t group = points_at_once(tiles, 0);
    CloudSurvey survey = phases.run("survey", 0.1, report.seconds.normals, [&] {
        CloudSurvey found = survey_cloud(*cloud, cloud->extent().finite(), group);
        check_survey(found, *cloud);
        return found;
    });
    const std::size_t duplicates = cloud->extent().finite() - survey.sums.points();
    WholeFacets facets = phases.run("tiles", 0.2, report.seconds.facets, [&] {
        return facets_of_tiles({*cloud, survey, options, phases, group, tiles.ghost_voxels}, tiles,
                               duplicates, report, how);
    });
    const std::size_t half = survey.sums.voxels() * bytes_per_voxel_of_mesh / 2; // the rest comes later
    Reconstruction result = finish_whole({*cloud, survey, options, phases, points_at_once(tiles, half)},
                                         std::move(facets), std::move(report));
    how.scratch_bytes = cloud->bytes();
    result.report.seconds.total =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace

void check_options(const ReconstructOptions& options, const TileOptions& tiles) {
    check_options(options);
    const auto need = [](bool holds, const char* what) {
        if (!holds) throw OptionError(std::string("memory: ") + what);
    };
    need(options.depth.has_value(), "must come with --depth, as the resolution is not chosen in tiles yet");
    need(*options.depth >= 4, "must come with a --depth of 4 or more");
    need(!wants_adaptive(options), "cannot come with an adaptive grid yet");
    need(method_for(options) == Method::extended, "cannot come with --method basic yet");
    need(options.normals != NormalSource::estimate, "cannot come with --normals estimate yet");
    need(options.holes == Holes::automatic || options.holes == Holes::keep,
         "can only come with --holes auto and keep yet");
    need(!options.merge_layers, "cannot come with --merge-layers yet");
    need(!options.min_component, "cannot come with --min-component yet");
    need(!wants_confidence(options), "cannot come with --confidence and --trim yet");
    need(options.debug_dir.empty(), "cannot come with --debug-dir yet");
    need(tiles.ghost_voxels >= 4, "needs a ghost layer of four voxels or more");
}

bool fits_in_one_piece(std::size_t points, const ReconstructOptions& options, std::size_t memory) {
    const bool any_voxels = options.depth || options.voxel_size;
    const std::size_t each = any_voxels ? bytes_per_point_of_any_voxels : bytes_per_point_of_one_piece;
    return memory > bytes_of_program && points <= (memory - bytes_of_program) / each;
}

Reconstruction reconstruct_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how) {
    check_options(options, tiles);
    TileReport unasked;
    const auto run = [&] { return run_tiles(parts, options, tiles, how ? *how : unasked); };
    if (options.threads == 0) return run();
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::task_arena arena(static_cast<int>(std::min(static_cast<std::size_t>(options.threads), allowed)));
    std::optional<Reconstruction> result;
    arena.execute([&] { result.emplace(run()); });
    return std::move(*result);
}

Reconstruction reconstruct_in_tiles(const PointView& cloud, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how) {
    return reconstruct_in_tiles([&](const auto& visit) { visit(cloud); }, options, tiles, how);
}

} // namespace hsdm
