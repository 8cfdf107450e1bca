#include "hsdm/pipeline/reconstruct_in_tiles.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/normals/steady_normals.hh"
#include "hsdm/pipeline/choose_resolution.hh"
#include "hsdm/pipeline/cloud_detail.hh"
#include "hsdm/pipeline/cloud_given_normals.hh"
#include "hsdm/pipeline/cloud_noise.hh"
#include "hsdm/pipeline/cloud_normals.hh"
#include "hsdm/pipeline/cloud_smoothing.hh"
#include "hsdm/pipeline/cloud_sparse_areas.hh"
#include "hsdm/pipeline/constants.hh"
#include "hsdm/pipeline/gather_pieces.hh"
#include "hsdm/pipeline/kept_passes.hh"
#include "hsdm/pipeline/make_tiles.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/part_store.hh"
#include "hsdm/pipeline/sparse_areas.hh"
#include "hsdm/pipeline/stray_search.hh"
#include "hsdm/pipeline/tile_plan.hh"
#include "hsdm/pipeline/tiled_draft.hh"
#include "hsdm/pipeline/whole_of_tiles.hh"
#include "hsdm/pipeline/work_of_ranks.hh"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace hsdm {
namespace {

using Clock = std::chrono::steady_clock;

/// So many points of so many bytes fit what is left of the memory.
std::size_t points_at_once(const TileOptions& tiles, std::size_t bytes_of_mesh, double bytes_each) {
    if (tiles.most_points > 0) return tiles.most_points;
    constexpr std::size_t fewest = std::size_t{1} << 18; // some tens of megabytes
    const std::size_t used = bytes_of_program + bytes_of_mesh;
    const auto left = static_cast<double>(tiles.memory - std::min(tiles.memory, used));
    return std::max(fewest, static_cast<std::size_t>(left / bytes_each));
}

/// A depth whose cells are not too many or too few for so many points. What is found does not depend on it.
int depth_for_cells(std::size_t points) {
    constexpr std::size_t most = 32; // points a voxel, of a surface across the cube
    int depth = 4;
    while (depth < deepest_level && points >> 2 * depth > most) ++depth;
    return depth;
}

double voxels_per_point(const Survey& sums) {
    return static_cast<double>(sums.voxels()) / static_cast<double>(sums.points());
}

/// What a run has in memory of a voxel of the mesh in the end.
struct VoxelBytes {
    std::size_t mesh, attributes;
    bool is_flat() const { return mesh == bytes_per_voxel_of_parked_mesh; }
    std::size_t all() const { return mesh + attributes; }
};

/// A tile may have what is left; of attributes a point takes so many bytes.
std::size_t points_of_tile(const TileOptions& tiles, const Survey& sums, const VoxelBytes& of_voxel,
                           std::size_t bytes_of_attributes) {
    if (tiles.most_points > 0) return tiles.most_points;
    const std::size_t voxels = sums.voxels();
    const std::size_t mesh = voxels * bytes_per_voxel_of_pieces;
    const std::size_t finished = voxels * of_voxel.all() + bytes_of_program;
    if (finished > tiles.memory)
        throw Error(
            "the mesh of " + std::to_string(voxels) + " voxels takes about "
            + std::to_string(finished / 1000000)
            + " MB, which is held in memory; give --memory that much, or a smaller --depth or larger "
              "--voxel-size"
            + (of_voxel.is_flat() ? "" : "; without --features, --intersections and --strict it takes less"));
    const auto left = static_cast<double>(tiles.memory - std::min(tiles.memory, mesh + bytes_of_program));
    const double each =
        bytes_per_tile_point(voxels_per_point(sums)) + static_cast<double>(bytes_of_attributes);
    return static_cast<std::size_t>(left / each);
}

/// What is known of the cloud, once tiles have been made.
void note_cloud(const ScratchCloud& cloud, const CloudSurvey& survey, std::size_t duplicates,
                const TilesKnown& known, Report& report) {
    const CloudExtent& extent = cloud.extent();
    const Occurrences outliers = known.outliers.value_or(Occurrences());
    const std::size_t voxels = survey.sums.voxels();
    report.input.points = extent.finite();
    report.input.dropped_nonfinite = extent.nonfinite;
    if (extent.nonfinite > 0) report.input.first_nonfinite = extent.first_nonfinite;
    report.input.merged_duplicates = duplicates;
    report.input.has_normals = extent.has_normals;
    report.input.bbox = cloud.bounds();
    report.input.spacing = survey.spacing;
    report.grid.depth = cloud.depth();
    report.grid.voxel_size = cloud.voxel_size();
    report.grid.voxels = voxels;
    report.grid.leaves_per_level.assign(static_cast<std::size_t>(cloud.depth()) + 1, 0);
    report.grid.leaves_per_level.back() = voxels;
    report.rejected["points_outlying"] = outliers.count;
    note_dropped("points off every surface", outliers, cloud.frame(), report);
}

/// A run up to the facets of the whole, which the first rank gets, and what finishing them needs.
class TiledRun {
public:
    /// `bytes_per_voxel`: of the mesh in the end.
    TiledRun(const PointParts& parts, const ReconstructOptions& options, const TileOptions& tiles,
             Ranks& ranks, std::size_t bytes_per_voxel)
        : options_(options),
          tiles_(tiles),
          ranks_(ranks),
          work_(ranks),
          phases_(options),
          bytes_per_voxel_(bytes_per_voxel),
          passes_(tiles.kept, ranks) {
        if (passes_.done() != Pass::none) take_state();
        report_.threads = tbb::this_task_arena::max_concurrency();
        run(Pass::sorted, "octree", 0, report_.seconds.octree, [&] { sort_points(parts); });
        constexpr std::size_t bytes_kept = sizeof(float); // of each point, by some passes
        const std::size_t group = points_at_once(tiles, bytes_kept * cloud_->points_here(), bytes_per_point);
        os::give_back_freed_memory(); // here and later, or what one phase had is held beside what the next
                                      // has
        run(Pass::surveyed, "survey", 0.1, report_.seconds.normals, [&] { survey_points(group); });
        if (estimates_)
            run(Pass::normals, "normals", 0.12, report_.seconds.normals, [&] { estimate_normals(group); });
        run(Pass::resolution, "resolution", 0.15, report_.seconds.octree, [&] { choose_resolution(group); });
        phases_.run("tiles", 0.2, report_.seconds.facets, [&] { make_facets(group); });
        note_options(estimates_, options_, report_); // this run's, whatever was kept
        note_left_out(cloud_->extent().attributes.left_out, report_);
        if (const std::size_t known = cloud_->extent().scanners.sensors.size(); known > 0)
            report_.options["sensors"] = std::to_string(known);
    }

    /// What finish(input, facets, report) makes of the facets; nothing on other ranks than the first.
    template <class Finish>
    auto finish(TileReport& how, const Finish& finish) {
        const std::size_t voxels = survey_->sums.voxels();
        const bool parks = bytes_of_voxel().is_flat()
                           && ranks_.of_first(bytes_of_flat_finish(facets_.mesh) + facets_.attributes.size()
                                                  + bytes_of_program
                                              > tiles_.memory);
        how_.parks = parks;
        const ScratchPlace parking{tiles_.scratch};
        const std::size_t mesh = voxels
                                 * (parks ? bytes_per_voxel_parked_in_error
                                          : bytes_per_voxel_in_error + bytes_of_voxel().attributes);
        const double each = bytes_per_error_point(voxels_per_point(survey_->sums));
        const WholeInput in{*cloud_,
                            as_read_ ? &*as_read_ : nullptr,
                            *survey_,
                            options_,
                            phases_,
                            points_at_once(tiles_, mesh, each),
                            parks ? &parking : nullptr};
        decltype(finish(in, std::move(facets_), std::move(report_))) result;
        if (ranks_.is_first())
            result = finish(in, std::move(facets_), std::move(report_));
        else if (options_.measure) {
            assist_error(in);
            if (options_.min_component && ranks_.of_first(false)) // small components are out now
                assist_error(in);
        }
        how_.ranks = work_.of_all({.points = cloud_->points_here(), .tiles = how_.own_tiles});
        how = how_;
        result.report.scratch_bytes = scratch_use().most;
        result.report.scratch_bytes_written = scratch_use().written;
        result.report.seconds.total = std::chrono::duration<double>(Clock::now() - start_).count();
        return result;
    }

private:
    /// A pass, unless it was kept.
    template <class Work>
    void run(Pass pass, const char* name, double share, double& seconds, const Work& work) {
        phases_.run(name, share, seconds, [&] {
            if (passes_.has(pass)) return;
            work();
            keep(pass);
        });
    }

    void keep(Pass pass, const Ranks::Bytes& normals = {}) {
        if (!passes_.is_kept()) return;
        Ranks::Bytes bytes;
        cloud_->put_state(bytes);
        put(survey_.has_value(), bytes);
        if (survey_) survey_->sums.put_state(bytes), put(survey_->spacing, bytes);
        put(duplicates_, bytes), put(estimates_, bytes), put(levels_, bytes);
        put(known_.has_layers, bytes), put(known_.outliers.has_value(), bytes);
        put(known_.outliers.value_or(Occurrences()), bytes);
        put(smoothed_, bytes), put(as_read_.has_value(), bytes);
        if (as_read_) as_read_->put_state(bytes);
        put(report_.input.spacing, bytes);
        put(std::uint64_t{report_.options.size()}, bytes);
        for (const auto& [name, value] : report_.options) put_text(name, bytes), put_text(value, bytes);
        put(std::uint64_t{report_.rejected.size()}, bytes);
        for (const auto& [name, count] : report_.rejected) put_text(name, bytes), put(count, bytes);
        put_vector(normals, bytes);
        passes_.keep(pass, *cloud_, as_read_ ? &*as_read_ : nullptr, bytes);
    }

    void take_state() {
        how_.went_on = true;
        const Ranks::Bytes bytes = passes_.state();
        ByteReader reader(bytes);
        cloud_.emplace(reader, tiles_, ranks_);
        if (reader.take<bool>()) {
            Survey sums(reader);
            survey_.emplace(CloudSurvey{std::move(sums), reader.take<double>()});
        }
        duplicates_ = reader.take<std::size_t>(), estimates_ = reader.take<bool>();
        levels_ = reader.take<int>();
        known_.has_layers = reader.take<bool>();
        const bool has_outliers = reader.take<bool>();
        const auto outliers = reader.take<Occurrences>();
        if (has_outliers) known_.outliers = outliers;
        smoothed_ = reader.take<SmoothReport>();
        if (reader.take<bool>()) as_read_.emplace(reader, tiles_, ranks_);
        report_.input.spacing = reader.take<double>();
        for (auto count = reader.take<std::uint64_t>(); count > 0; --count) {
            std::string name = reader.take_text();
            report_.options[std::move(name)] = reader.take_text();
        }
        for (auto count = reader.take<std::uint64_t>(); count > 0; --count) {
            std::string name = reader.take_text();
            report_.rejected[std::move(name)] = reader.take<std::size_t>();
        }
        normals_begun_ = reader.take_vector<char>();
    }

    void sort_points(const PointParts& parts) {
        const CloudExtent extent = measure_extent(parts, ranks_);
        const int depth = options_.depth.value_or(depth_for_cells(extent.finite()));
        const bool given = extent.has_normals && options_.normals != NormalSource::estimate;
        estimates_ = !given;
        check_normals_asked_for();
        cloud_.emplace(parts, extent, depth, tiles_, ranks_, given);
    }

    void survey_points(std::size_t group) {
        survey_.emplace(survey_cloud(*cloud_, cloud_->extent().finite(), group));
        refuse_unfit_places(*survey_, *cloud_);
        duplicates_ = cloud_->extent().finite() - survey_->sums.points();
    }

    void check_normals_asked_for() const {
        if (!estimates_) return;
        if (options_.normals == NormalSource::given)
            throw Error("normals given were asked for, but the cloud has none; use --normals auto or "
                        "estimate");
    }

    /// Relative to the cube.
    CloudScanners scanners() const {
        return cloud_->extent().scanners.placed(cloud_->frame(), cloud_->origin());
    }

    void estimate_normals(std::size_t group) {
        const std::function<void(bool, const Ranks::Bytes&)> keep_begun =
            [&](bool sided, const Ranks::Bytes& begun) { keep(sided ? Pass::sided : Pass::cleaned, begun); };
        const CloudNormalsOptions how{passes_of(group), scanners(), memory_left(),
                                      passes_.is_kept() ? keep_begun : nullptr,
                                      std::exchange(normals_begun_, {})};
        const NormalsReport made = make_cloud_normals(*cloud_, *survey_, how, as_read_);
        known_.outliers = made.outliers;
        smoothed_ = made.smoothed;
        report_.rejected["normals_near_creases"] = made.bent;
        report_.rejected["normals_missing"] = made.missing;
        report_.rejected["normals_by_volume"] = made.orientation.by_volume;
        report_.rejected["normals_of_layers"] = made.orientation.of_layers;
        known_.has_layers = made.orientation.of_layers > 0;
        report_.rejected["points_between_sheets"] = smoothed_.between.count;
    }

    /// As PreparedCloud has it. Returns the noise of positions. Of outliers that nothing else hangs on tiles
    /// find out later.
    double check_given_normals(std::size_t group) {
        const auto consistency = [&] {
            return check_normals(survey_->sums.normals(), survey_->sums.points(), survey_->spacing);
        };
        const auto noise_by = [&](const NormalConsistency& found) {
            return found.rough() ? cloud_noise(*cloud_, *survey_, passes_of(group)).deviation : 0;
        };
        const bool scattered = are_scattered(survey_->sums.normals(), survey_->sums.points());
        const bool trusted = !scattered && !consistency().doubtful();
        double noise = trusted ? noise_by(consistency()) : 0;
        if (!options_.depth || noise > 0 || !trusted)
            known_.outliers =
                drop_strays(*cloud_, *survey_, plan(group), tiles_.ghost_voxels, group).outliers;
        if (trusted) return noise;
        PartStore store(*cloud_, tiles_.ghost_voxels);
        if (scattered)
            report_.rejected["normals_steadied"] =
                steady_cloud_normals(*cloud_, *survey_, passes_of(group), store);
        noise = noise_by(consistency());
        if (consistency().doubtful())
            report_.rejected["normals_mended"] = mend_cloud_normals(
                *cloud_, *survey_, scanners().orientation(), passes_of(group), memory_left(), store);
        return noise;
    }
    std::size_t memory_left() const { return tiles_.memory - std::min(tiles_.memory, bytes_of_program); }

    /// As PreparedCloud has it, for voxels that are chosen.
    void smooth_for_voxels(double noise, std::size_t group) {
        if (noise <= relations::smooth_gap * cloud_->voxel_size()) return;
        PartStore store(*cloud_, tiles_.ghost_voxels);
        smoothed_ = smooth_cloud(*cloud_, *survey_, noise, passes_of(group).plan, group, store, as_read_);
        report_.rejected["points_between_sheets"] = smoothed_.between.count;
    }

    CloudPasses passes_of(std::size_t group) const {
        return {[group](const ScratchCloud& cloud, int ghost) { return plan(cloud, group, ghost); },
                tiles_.ghost_voxels, group};
    }

    /// Mends given normals. Where no depth is given voxels follow from the points without outliers, which
    /// move to their cube; noisy points move for such voxels. All of it is one pass.
    void choose_resolution(std::size_t group) {
        const int ghost = tiles_.ghost_voxels;
        const double noise = estimates_ ? smoothed_.noise : check_given_normals(group);
        report_.input.spacing = survey_->spacing;
        const auto rearrange = [&](const VoxelCube& cube) {
            cloud_->rearrange(cloud_->bounds(), cube.extent, cube.depth, group);
            if (as_read_) as_read_->rearrange(cloud_->bounds(), cube.extent, cube.depth, group);
            survey_of_cube(group);
        };
        const auto detail = [&](int) { return detail_of(*cloud_, plan(group), ghost); };
        hsdm::choose_resolution(options_, {cloud_->no_points(), cloud_->frame(), noise, rearrange, detail},
                                report_);
        if (!estimates_) smooth_for_voxels(noise, group);
        if (options_.depth && estimates_) survey_of_cube(group); // with normals
        levels_ = are_voxels_asked_for(options_, report_) ? 0 : levels_above_sparse(*cloud_, group);
        note_coarser_levels(levels_, report_);
    }

    /// The spacing stays that of the cube before.
    void survey_of_cube(std::size_t group) {
        survey_->sums = survey_cloud(*cloud_, survey_->sums.points(), group).sums;
    }

    void make_facets(std::size_t group) {
        facets_ =
            facets_of_drafts({*cloud_, *survey_, known_, options_, phases_, passes_of(group),
                              ScratchPlace{tiles_.scratch}, memory_left(), levels_,
                              [&](TiledDraft& draft, bool turned) { make_tiles_of(draft, turned, group); }},
                             report_);
        note_cloud(*cloud_, *survey_, duplicates_, known_, report_);
        note_dropped("noisy points between sheets", smoothed_.between, cloud_->frame(), report_);
        if (smoothed_.noise > 0) report_.rejected["points_moved"] = survey_->sums.points();
        if (!estimates_)
            for (const char* name : {"normals_steadied", "normals_mended"}) report_.rejected[name];
    }

    /// Facets of the points of a draft, or of the measured ones.
    void make_tiles_of(TiledDraft& draft, bool turned, std::size_t group) {
        ScratchCloud& cloud = draft.cloud ? *draft.cloud : *cloud_;
        CloudSurvey& survey = draft.cloud ? *draft.survey : *survey_;
        TilesKnown& known = draft.cloud ? draft.known : known_;
        store_.emplace(passes_.pieces(tiles_.scratch));
        const TilesInput in{cloud,           survey,     options_,
                            phases_,         group,      tiles_.ghost_voxels,
                            &*store_,        &passes_,   [&] { keep(Pass::strays); },
                            draft.completed, draft.added};
        draft.facets = WholeFacets();
        os::give_back_freed_memory();
        std::vector<VoxelRange> ranges;
        std::optional<std::vector<Piece>> pieces;
        do {
            const std::size_t most =
                points_of_tile(tiles_, survey.sums, bytes_of_voxel(), cloud.attributes().bytes());
            ranges = plan(cloud, most, tiles_.ghost_voxels);
            count_tiles(cloud, ranges);
            pieces = make_tiles(in, ranges, turned, known, how_);
        } while (!pieces);
        gather_pieces(
            *pieces, *store_, [&](std::size_t k) { return cloud.owner_of(ranges[k]); }, ranks_);
        os::give_back_freed_memory();
        draft.facets = join_tiles(std::move(*pieces), &*store_);
        draft.facets.rows = cloud.attributes().of_vertices();
    }

    VoxelBytes bytes_of_voxel() const {
        VoxelBytes bytes{bytes_per_voxel_, cloud_->attributes().bytes()};
        if (!bytes.is_flat()) bytes.attributes = cloud_->attributes().columns().size() * bytes_per_property;
        return bytes;
    }
    std::vector<VoxelRange> plan(std::size_t most) const { return plan(*cloud_, most, tiles_.ghost_voxels); }
    static std::vector<VoxelRange> plan(const ScratchCloud& cloud, std::size_t most, int ghost) {
        return plan_tiles(cloud.cells(), {cloud.depth(), cloud.cell_depth(), ghost, most, cloud.borders()});
    }
    void count_tiles(const ScratchCloud& cloud, const std::vector<VoxelRange>& ranges) {
        how_.tiles = ranges.size();
        how_.own_tiles = static_cast<std::size_t>(std::ranges::count_if(
            ranges, [&](const VoxelRange& range) { return cloud.owner_of(range) == ranks_.rank(); }));
    }

    const Clock::time_point start_ = Clock::now();
    const ReconstructOptions& options_;
    const TileOptions& tiles_;
    Ranks& ranks_;
    const WorkOfRanks work_;
    const Phases phases_;
    const std::size_t bytes_per_voxel_;
    Report report_;
    std::optional<ScratchCloud> cloud_;
    std::optional<ScratchCloud> as_read_; // where the points were, if they have been moved
    SmoothReport smoothed_;
    std::optional<CloudSurvey> survey_;
    std::optional<PieceStore> store_;
    std::size_t duplicates_ = 0;
    bool estimates_ = false; // normals
    int levels_ = 0;         // coarser ones, that help out where points are sparse
    TilesKnown known_;
    KeptPasses passes_;
    Ranks::Bytes normals_begun_; // and kept
    WholeFacets facets_;
    TileReport how_;
};

/// Calls run() with as many threads as asked for.
template <class Run>
auto with_threads(int threads, const Run& run) {
    if (threads == 0) return run();
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::task_arena arena(static_cast<int>(std::min(static_cast<std::size_t>(threads), allowed)));
    std::optional<decltype(run())> result;
    arena.execute([&] { result.emplace(run()); });
    return std::move(*result);
}

} // namespace

void check_options(const ReconstructOptions& options, const TileOptions& tiles) {
    check_options(options);
    const auto need = [](bool holds, const char* what) {
        if (!holds) throw OptionError(std::string("memory: ") + what);
    };
    need(!options.max_error, "cannot come with --max-error yet");
    need(!wants_adaptive(options), "cannot come with an adaptive grid yet");
    need(method_for(options) == Method::extended, "cannot come with --method basic yet");
    need(!options.merge_layers, "cannot come with --merge-layers yet");
    need(!wants_confidence(options), "cannot come with --confidence and --trim yet");
    need(options.debug_dir.empty(), "cannot come with --debug-dir yet");
    need(tiles.ghost_voxels >= 4, "needs a ghost layer of four voxels or more");
}

bool fits_in_one_piece(std::size_t points, const ReconstructOptions& options, std::size_t memory) {
    const bool any_voxels = options.depth || options.voxel_size;
    const std::size_t each = any_voxels ? bytes_per_point_of_any_voxels : bytes_per_point_of_one_piece;
    return memory > bytes_of_program && points <= (memory - bytes_of_program) / each;
}

namespace {

/// finish(in, facets, report): the whole, of which a voxel takes so many bytes.
template <class Finish>
auto run_in_tiles(const PointParts& parts, const ReconstructOptions& options, const TileOptions& tiles,
                  Ranks& ranks, TileReport* how, std::size_t bytes_per_voxel, const Finish& finish) {
    check_options(options, tiles);
    TileReport unasked;
    return with_threads(options.threads, [&] {
        return TiledRun(parts, options, tiles, ranks, bytes_per_voxel).finish(how ? *how : unasked, finish);
    });
}

} // namespace

Reconstruction reconstruct_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how) {
    OneRank alone;
    return reconstruct_in_tiles(parts, options, tiles, alone, how);
}

Reconstruction reconstruct_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                    const TileOptions& tiles, Ranks& ranks, TileReport* how) {
    return run_in_tiles(parts, options, tiles, ranks, how, bytes_per_voxel_of_mesh, finish_whole);
}

FlatReconstruction reconstruct_flat_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                             const TileOptions& tiles, TileReport* how) {
    OneRank alone;
    return reconstruct_flat_in_tiles(parts, options, tiles, alone, how);
}

FlatReconstruction reconstruct_flat_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                             const TileOptions& tiles, Ranks& ranks, TileReport* how) {
    return run_in_tiles(parts, options, tiles, ranks, how, bytes_per_voxel_of_parked_mesh, finish_whole_flat);
}

Reconstruction reconstruct_in_tiles(const PointView& cloud, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how) {
    return reconstruct_in_tiles([&](const auto& visit) { visit(cloud); }, options, tiles, how);
}

} // namespace hsdm
