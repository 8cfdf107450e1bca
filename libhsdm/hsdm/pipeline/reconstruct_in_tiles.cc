#include "hsdm/pipeline/reconstruct_in_tiles.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/contour/sheet_features.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/scratch_points.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/normals/steady_normals.hh"
#include "hsdm/pipeline/finish_mesh.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/survey.hh"
#include "hsdm/pipeline/tile_piece.hh"
#include "hsdm/pipeline/tile_plan.hh"
#include "hsdm/quality/distance_to_surface.hh"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numbers>

namespace hsdm {
namespace {

constexpr int most_ghost_voxels = 256;                    // of a tile that is made again and again
constexpr std::size_t most_strays = std::size_t{1} << 20; // that are kept in memory

[[noreturn]] void refuse(const std::string& what) {
    throw Error(what + "; this is not done in tiles, reconstruct it in one piece (without --memory)");
}

/// What the first pass over the points finds.
struct Extent {
    std::size_t points = 0;
    NonfiniteRows nonfinite;
    Box box;
};

class TiledRun {
public:
    TiledRun(const PointParts& parts, const ReconstructOptions& options, const TileOptions& tiles)
        : parts_(parts), options_(options), tiles_(tiles), phases_(options) {}

    Reconstruction run(TileReport* how) {
        const auto start = std::chrono::steady_clock::now();
        Report report;
        report.threads = tbb::this_task_arena::max_concurrency();
        note_options(false, options_, report);
        report.options["depth"] = std::to_string(depth());
        report.options["resolution"] = "as asked by depth";
        phases_.run("octree", 0, report.seconds.octree, [&] {
            measure_extent();
            sort_to_scratch();
        });
        phases_.run("survey", 0.1, report.seconds.normals, [&] { survey(); });
        PolygonMesh mesh;
        FacetKnowledge known;
        phases_.run("tiles", 0.2, report.seconds.facets, [&] { mesh = make_facets(report, known); });
        Reconstruction result;
        const Octree none = empty_octree();
        OctreeLevel level;
        level.depth = depth();
        level.voxel_size = none.voxel_size(depth());
        const MethodInput in{frame_, {}, none, level, options_, phases_};
        finish_mesh(
            in, std::move(mesh), std::move(known), std::move(report), result,
            [&](PolygonMesh& facets, FacetKnowledge& what, Report& of) { measure(in, facets, what, of); });
        result.report.seconds.total =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        how_.scratch_bytes = scratch_->bytes();
        if (how) *how = how_;
        return result;
    }

private:
    int depth() const { return *options_.depth; }

    /// First pass over the points.
    void measure_extent() {
        parts_([&](const PointView& part) {
            check_view(part);
            if (!part.has_normals()) refuse("the cloud has no normals, which would have to be estimated");
            if (part.colors.count > 0 || !part.scalars.empty()) refuse("the cloud has colours or scalars");
            const NonfiniteRows nonfinite = find_nonfinite(part.positions);
            if (nonfinite.count > 0 && extent_.nonfinite.count == 0)
                extent_.nonfinite.first = extent_.points + nonfinite.first;
            extent_.nonfinite.count += nonfinite.count;
            extent_.points += part.size();
            extent_.box.add(finite_bounds(part.positions));
        });
        if (extent_.points == 0) throw Error("the cloud holds no point; nothing can be reconstructed");
        if (extent_.points >= no_index) refuse("the cloud holds 2^32 points or more");
        if (2 * extent_.nonfinite.count > extent_.points)
            throw Error(std::to_string(extent_.nonfinite.count) + " of " + std::to_string(extent_.points)
                        + " points have coordinates that are not finite; check how the file was exported");
        const Vec3 zero(0, 0, 0); // -0 becomes 0, as in the octree
        extent_.box = {extent_.box.lo + zero, extent_.box.hi + zero};
        frame_ = CloudFrame(extent_.box);
        if (frame_.unit() != 1) refuse("the cloud is of extreme size");
        if (!has_voxels(extent_.box)) throw Error("all points are equal; a surface needs points that differ");
        octree_options_.placement = CubePlacement::centred;
        octree_options_.whole = extent_.box;
        cube_extent_ = extent_.box.extent();
        origin_ = centred_origin(extent_.box, cube_extent_);
        cell_depth_ = cell_depth_of(depth());
    }

    std::size_t finite_points() const { return extent_.points - extent_.nonfinite.count; }

    /// Second pass over the points.
    void sort_to_scratch() {
        const std::size_t buffered = std::max<std::size_t>(tiles_.memory / 8, std::size_t{1} << 20);
        scratch_.emplace(tiles_.scratch, finite_points(), buffered);
        std::size_t added = 0;
        parts_([&](const PointView& part) {
            for_each_in_order(part.size(), [&](std::size_t i) {
                const Vec3 p = vec3_at(part.positions, i), n = vec3_at(part.normals, i);
                if (!is_finite(p)) return;
                const MortonCode code = code_at(p - origin_, cube_extent_);
                scratch_->add(code >> 3 * (morton_levels - cell_depth_),
                              {p[0], p[1], p[2], n[0], n[1], n[2]});
                ++added;
            });
        });
        scratch_->finish();
        if (added != finite_points())
            throw Error("the points have changed while they were read; read them again");
        cells_ = scratch_->cells();
    }

    Octree octree_of(const std::vector<PointRow>& rows) const {
        PointView view;
        view.positions = StridedSpan(rows.front().data(), rows.size(), sizeof(PointRow));
        view.normals = StridedSpan(rows.front().data() + 3, rows.size(), sizeof(PointRow));
        Octree octree = build_octree(view, octree_options_);
        if (strays_known_ && !strays_.empty()) {
            std::vector<std::uint8_t> marks = large_vector<std::uint8_t>(octree.size(), 0);
            for_each_index(octree.size(), chunks::usual, [&](Index i) {
                marks[i] = std::ranges::binary_search(strays_, row_at(octree, i));
            });
            remove_points(octree, marks);
        }
        return octree;
    }

    static PointRow row_at(const Octree& octree, std::size_t i) {
        const Vec3 &p = octree.positions[i], &n = octree.normals[i];
        return {p[0], p[1], p[2], n[0], n[1], n[2]};
    }

    Octree empty_octree() const {
        Octree octree;
        octree.origin = origin_;
        octree.extent = cube_extent_;
        octree.bounds = extent_.box;
        return octree;
    }

    /// visit(octree) of all points, some cells after the other, in Morton order.
    template <class Visit>
    void for_groups(const Visit& visit) const {
        const std::size_t most = points_at_once();
        std::vector<PointRow> rows;
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            scratch_->read(cells_[c].code, rows);
            if (c + 1 < cells_.size() && rows.size() + cells_[c + 1].points <= most) continue;
            const Octree octree = octree_of(rows);
            rows = std::vector<PointRow>();
            visit(octree);
        }
    }

    /// So many points, with what is made of them, fit what is left of the memory.
    std::size_t points_at_once() const {
        if (tiles_.most_points > 0) return tiles_.most_points;
        constexpr std::size_t fewest = std::size_t{1} << 18; // some tens of megabytes
        const std::size_t used = bytes_of_program + bytes_of_mesh_;
        return std::max(fewest, used < tiles_.memory ? (tiles_.memory - used) / bytes_per_point : 0);
    }

    /// What PreparedCloud finds out, and that nothing has to be done that it does then.
    void survey() {
        take_survey(finite_points());
        duplicates_ = finite_points() - survey_->points();
        sparse_ = survey_->sparse();
        if (spans_no_surface(survey_->places(), cube_extent_)) refuse("too few points, or all on a line");
        if (has_far_points(survey_->places(), cube_extent_, spacing_))
            refuse("some points, or parts, are far from all others");
        if (are_scattered(survey_->normals(), survey_->points()))
            refuse("normals are noisy, and may have to be told by the positions");
        const NormalConsistency normals = check_normals(survey_->normals(), survey_->points(), spacing_);
        if (normals.doubtful()) refuse("normals contradict each other and must be turned to one side");
        if (normals.rough()) refuse("normals contradict positions, as those of noisy points do");
    }

    void take_survey(std::size_t expected) {
        survey_.emplace(depth(), cell_depth_, expected);
        for_groups([&](const Octree& part) { survey_->add(part); });
        if (const std::size_t points = survey_->points(); points != expected) // other ones are sampled
            return take_survey(points);
        spacing_ = estimate_spacing(survey_->counts(), cube_extent_);
    }

    void note_cloud(Report& report) const {
        report.input.points = finite_points();
        report.input.dropped_nonfinite = extent_.nonfinite.count;
        if (extent_.nonfinite.count > 0) report.input.first_nonfinite = extent_.nonfinite.first;
        report.input.merged_duplicates = duplicates_;
        report.input.has_normals = true;
        report.input.bbox = extent_.box;
        report.input.spacing = spacing_;
        report.grid.depth = depth();
        report.grid.voxel_size = empty_octree().voxel_size(depth());
        report.grid.voxels = survey_->voxels();
        report.grid.leaves_per_level.assign(static_cast<std::size_t>(depth()) + 1, 0);
        report.grid.leaves_per_level.back() = survey_->voxels();
        report.rejected["normals_mended"] = 0;
        report.rejected["points_outlying"] = strays_.size();
        note_dropped("points off every surface", {strays_.size(), first_stray_ + origin_}, frame_, report);
    }

    /// The points of a tile and of what is around it.
    std::vector<PointRow> rows_of(const VoxelRange& range, int ghost) const {
        std::vector<PointRow> rows, cell;
        const int shift = 3 * (depth() - cell_depth_), to_level = 3 * (morton_levels - depth());
        const int cells_around = (ghost >> (depth() - cell_depth_)) + 1;
        VoxelRange of_cells{range.begin >> shift, range.end >> shift, cell_depth_, 0};
        for (const ScratchPoints::Cell& c : cells_) {
            if (of_cells.holds(c.code)) {
                scratch_->read(c.code, rows);
                continue;
            }
            if (!of_cells.is_near(morton_decode(c.code), cells_around)) continue;
            Interruption::poll();
            cell.clear();
            scratch_->read(c.code, cell);
            for (const PointRow& row : cell) {
                const MortonCode code = code_at(Vec3(row[0], row[1], row[2]) - origin_, cube_extent_);
                if (range.is_near(morton_decode(code >> to_level), ghost)) rows.push_back(row);
            }
        }
        return rows;
    }

    Piece make_tile(const VoxelRange& range, int ghost, bool turned) {
        Piece piece;
        piece.range = range;
        std::vector<PointRow> rows = rows_of(range, ghost);
        how_.points_read += rows.size();
        if (rows.empty()) return piece;
        const Octree octree = octree_of(rows);
        rows = std::vector<PointRow>();
        if (!strays_known_) find_strays(octree, range, ghost);
        if (!strays_known_ && !strays_.empty()) return piece; // all are made again without them
        const OctreeLevel level = extract_level(octree, depth());
        const MethodInput in{frame_, {}, octree, level, options_, phases_};
        const PartOfLevel part{spacing_, survey_->set_sizes().typical(), turned, go_back_,
                               [&](MortonCode code) { return range.holds(code); }};
        return make_piece(in, part, range);
    }

    /// Adds a tile's points that are dropped as outliers. Refuses those without which the whole would have
    /// another cube.
    void find_strays(const Octree& octree, const VoxelRange& range, int ghost) {
        std::vector<double> reach;
        const std::vector<std::uint8_t> strays = strays_by_normals(octree, sparse_, {}, &reach);
        const double known = ghost * octree.voxel_size(depth());
        const int shift = 3 * (morton_levels - depth());
        for_each_in_order(octree.size(), [&](std::size_t i) {
            if (!range.holds(octree.codes[i] >> shift)) return;
            if (reach[i] > known) refuse("some points are far from all others");
            if (!strays[i]) return;
            if (is_at_border(octree.positions[i] + origin_))
                refuse("some points are off every surface, outside all others");
            if (strays_.empty()) first_stray_ = octree.positions[i];
            if (strays_.size() == most_strays) refuse("many points are off every surface");
            strays_.push_back(row_at(octree, i));
        });
    }

    bool is_at_border(const Vec3& place) const {
        const double near = 1e-9 * cube_extent_;
        return std::min((place - extent_.box.lo).min(), (extent_.box.hi - place).min()) <= near;
    }

    /// Once all tiles have looked for strays: are there some, so that all is different without them?
    bool has_new_strays() {
        const bool some = !strays_known_ && !strays_.empty();
        strays_known_ = true;
        if (!some) return false;
        std::ranges::sort(strays_);
        take_survey(survey_->points() - strays_.size());
        return true;
    }

    /// All tiles, each with as much around it as it takes for neighbours to agree.
    std::vector<Piece> make_pieces(const std::vector<VoxelRange>& ranges, bool turned) {
        std::vector<Piece> pieces(ranges.size());
        std::vector<int> ghost(ranges.size(), tiles_.ghost_voxels);
        std::vector<std::uint8_t> due(ranges.size(), 1);
        while (std::ranges::count(due, 1) > 0) {
            for (std::size_t k = 0; k < ranges.size(); ++k) {
                if (!due[k]) continue;
                if (ghost[k] > most_ghost_voxels) refuse("neighbouring parts do not agree");
                pieces[k] = make_tile(ranges[k], ghost[k], turned);
                if (pieces[k].counts.depends_on_all)
                    refuse(
                        "facets pass through each other that could not be parted, or normals are at random");
            }
            if (has_new_strays()) {
                std::ranges::fill(due, std::uint8_t{1});
                continue;
            }
            due = disagreeing(pieces);
            for (std::size_t k = 0; k < ranges.size(); ++k)
                if (due[k]) ghost[k] *= 2, ++how_.widened;
            if (std::ranges::count(due, 1) == 0 && must_go_back(pieces))
                std::ranges::fill(due, std::uint8_t{1});
        }
        return pieces;
    }

    static std::vector<std::uint8_t> disagreeing(const std::vector<Piece>& pieces) {
        std::vector<std::uint8_t> found(pieces.size(), 0);
        for (std::size_t i = 0; i < pieces.size(); ++i)
            for (std::size_t j = i + 1; j < pieces.size(); ++j)
                if (!agree(pieces[i], pieces[j])) found[i] = found[j] = 1;
        return found;
    }

    PolygonMesh make_facets(Report& report, FacetKnowledge& known) {
        const std::vector<VoxelRange> ranges =
            plan_tiles(cells_, {depth(), cell_depth_, tiles_.ghost_voxels, points_of_tile()});
        how_.tiles = ranges.size();
        PolygonMesh mesh;
        for (const bool turned : {false, true}) {
            FacetCounts counts;
            std::vector<Piece> pieces = make_pieces(ranges, turned);
            for (const Piece& piece : pieces) counts += piece.counts;
            known = FacetKnowledge();
            mesh = joined_pieces(std::move(pieces), known.hints.sides);
            judge(counts, known);
            report.grid.sets = counts.sets;
            report.rejected["normals_turned"] = turned ? survey_->points() : 0;
            if (turned || !faces_inward(mesh)) break; // or once more: what is judged depends on the side
        }
        note_cloud(report);
        check_facets(mesh, report);
        check_whole(mesh);
        bytes_of_mesh_ = survey_->voxels() * bytes_per_voxel_of_mesh / 2; // the rest comes later
        const auto count = mesh.vertex_count();
        mesh.properties.push_back({"hsdm_level", VertexProperty::Type::uint8,
                                   std::vector<double>(count, static_cast<double>(depth()))});
        return mesh;
    }

    /// A tile may have what its own facets and those of all tiles will leave.
    std::size_t points_of_tile() const {
        if (tiles_.most_points > 0) return tiles_.most_points;
        const std::size_t mesh = survey_->voxels() * bytes_per_voxel_of_pieces;
        const std::size_t finished = survey_->voxels() * bytes_per_voxel_of_mesh + bytes_of_program;
        if (finished > tiles_.memory)
            throw Error("the mesh of " + std::to_string(survey_->voxels()) + " voxels takes about "
                        + std::to_string(finished / 1000000)
                        + " MB, which is held in memory; give --memory that " + "much, or a smaller --depth");
        return (tiles_.memory - std::min(tiles_.memory, mesh + bytes_of_program)) / bytes_per_point;
    }

    /// Vertices as moved towards the points stay only where that brings all together nearer. Are they to go
    /// back, and have not yet?
    bool must_go_back(const std::vector<Piece>& pieces) {
        FacetCounts all;
        for (const Piece& piece : pieces) all += piece.counts;
        const double gain = all.misfit_placed - all.misfit_moved;
        constexpr double rounding = 1e-9; // sums of parts are rounded otherwise than that of the whole
        if (std::abs(gain) <= rounding * all.misfit_placed && all.misfit_placed > 0)
            refuse("facets moved to the points are neither nearer to them nor farther off");
        return !std::exchange(go_back_, gain < 0) && go_back_;
    }

    static void judge(const FacetCounts& counts, FacetKnowledge& known) {
        SheetFeatures features;
        features.middle = counts.middle, features.tilted = counts.tilted;
        features.hints = std::move(known.hints);
        judge_normals(features);
        known.hints = std::move(features.hints);
    }

    /// Refuses what was taken for granted of the whole and is not so.
    void check_whole(const PolygonMesh& mesh) const {
        const SplinterOptions splinters;
        const std::size_t most = std::max({splinters.most_facets, splinters.most_open, splinters.most_flat});
        if (static_cast<double>(largest_component(mesh)) < splinters.least_ratio * static_cast<double>(most))
            refuse("no part of the mesh is large");
        OctreeLevel level;
        level.depth = depth();
        level.voxel_size = empty_octree().voxel_size(depth());
        const Octree none;
        const MethodInput in{frame_, {}, none, level, options_, phases_};
        if (options_.holes == Holes::automatic && has_slits(in, spacing_, mesh))
            refuse("a slit has to be closed (--holes keep would leave it)");
    }

    /// Error and topology; distances of points group by group.
    void measure(const MethodInput& in, PolygonMesh& facets, FacetKnowledge& known, Report& report) const {
        drop_and_measure({}, in, facets, known, report);
        if (!options_.measure) return;
        if (!known.cells) known.cells.emplace(facets, report.grid.voxel_size);
        const FacetCells& cells = *known.cells;
        DistanceSums sums(std::numbers::sqrt3 * report.grid.voxel_size);
        Occurrences off;
        std::vector<Vec3> points; // as many at once as in one piece: what one search finds speeds up the next
        const auto add = [&](std::size_t count) {
            const std::size_t before = sums.count();
            const std::span<const Vec3> first = std::span(points).first(count);
            sums.add(squared_distances_by_cells(first, facets, cells));
            const Distance so_far = sums.result();
            if (off.count == 0 && so_far.beyond > 0)
                off.first = points[so_far.first_beyond - before] + origin_;
            off.count = so_far.beyond;
            points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
        };
        for_groups([&](const Octree& part) {
            append_large(points, part.positions);
            add(points.size() / chunks::usual * chunks::usual);
        });
        add(points.size());
        const Distance distance = sums.result();
        report.error.points_to_mesh_max = distance.max;
        report.error.points_to_mesh_mean = distance.mean;
        report.error.points_to_mesh_rms = distance.rms;
        report.error.normalised_max = distance.max / extent_.box.diagonal();
        note_dropped("points more than a voxel's diagonal off the mesh", off, frame_, report);
    }

    const PointParts& parts_;
    const ReconstructOptions& options_;
    const TileOptions& tiles_;
    const Phases phases_;
    CloudFrame frame_;
    Extent extent_;
    OctreeOptions octree_options_;
    Vec3 origin_{0, 0, 0};
    double cube_extent_ = 0;
    int cell_depth_ = 0;
    std::optional<ScratchPoints> scratch_;
    std::vector<ScratchPoints::Cell> cells_;
    std::optional<Survey> survey_;
    double spacing_ = 0;
    SparseLevel sparse_;
    std::size_t duplicates_ = 0;
    std::vector<PointRow> strays_; // as the octrees have them; ascending once they are known
    bool strays_known_ = false;
    bool go_back_ = false;
    Vec3 first_stray_{0, 0, 0};
    std::size_t bytes_of_mesh_ = 0;
    TileReport how_;
};

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
    const auto run = [&] { return TiledRun(parts, options, tiles).run(how); };
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
