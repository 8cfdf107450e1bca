// hsdm reconstruct: clouds in, meshes out.

#include "activity.hh"
#include "command.hh"
#include "mesh_stages.hh"
#include "messages.hh"
#include "page.hh"
#include "rank_work.hh"
#include "reconstruct_arguments.hh"
#include "reconstruct_output.hh"
#include "summary.hh"
#include "threads.hh"

#include "hsdm/core/ranks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/join_points.hh"
#include "hsdm/io/json_text.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/points_in_parts.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/kept_passes.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/work_of_ranks.hh"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <span>

namespace hsdm::command {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

ReconstructOptions checked_options(const ReconstructArguments& arguments,
                                   const std::optional<std::pair<int, int>>& levels) {
    ReconstructOptions options = arguments.options();
    if (levels) {
        check_options(options, levels->first, levels->second);
    } else {
        check_options(options);
    }
    check_options(arguments.read);
    return options;
}

/// Returns make(); puts a cloud's name before the messages of its errors.
template <class Make>
auto named(const CloudFiles& cloud, const Make& make) {
    try {
        return make();
    } catch (const OtherRankFailed&) { // all ranks say the same, and know it
        throw;
    } catch (const RefusedInTiles& refusal) {
        throw RefusedInTiles(cloud.name(), refusal.what());
    } catch (const Error& error) {
        const std::string_view what = error.what();
        if (std::ranges::any_of(cloud.files,
                                [&](const std::string& file) { return what.starts_with(file + ":"); }))
            throw; // of reading
        throw Error(cloud.name(), error.what());
    } catch (const OptionError& error) {
        throw OptionError(words_of(error) + " (" + cloud.name() + ")");
    }
}

/// Returns make(). If it throws, tells what stays of the job; nothing does of a cloud that tiles cannot do,
/// but that a run of several ranks may be of use to fewer, unless they give it up.
template <class Make>
auto with_kept_told(std::optional<KeptScratch>& kept, const Ranks& ranks, bool gives_up, const Make& make) {
    const auto tell = [&] {
        if (kept && ranks.is_first())
            complain("what is done stays in " + kept->folder()
                     + (ranks.size() > 1 ? " and those beside it" : "")
                     + "; the same command goes on with it, or remove it");
    };
    try {
        return make();
    } catch (const RefusedInTiles&) {
        if (kept && ranks.size() == 1) {
            kept->remove();
            kept.reset();
        } else if (!gives_up) {
            tell();
        }
        throw;
    } catch (const OtherRankGaveUp&) {
        throw;
    } catch (...) {
        tell();
        throw;
    }
}

/// What is told beside the points of files, of which each rank has read some.
PointFile notes_of_all(const PointsInParts& points, Ranks& ranks) {
    PointFile all;
    const PointFile& own = points.file();
    if (points.in_memory()) { // each has read all
        add_notes(own, all);
        return all;
    }
    Ranks::Bytes bytes;
    put(own.nonfinite, bytes), put(own.withheld, bytes), put(own.first_withheld, bytes);
    append_bytes(std::span<const char>(own.columns), bytes);
    for (const Ranks::Bytes& got : ranks.gather(bytes)) {
        ByteReader reader(got);
        PointFile next;
        next.nonfinite = reader.take<std::size_t>(), next.withheld = reader.take<std::size_t>();
        next.first_withheld = reader.take<Vec3>();
        const std::vector<char> columns = reader.take_rest<char>();
        next.columns.assign(columns.begin(), columns.end());
        add_notes(next, all);
    }
    return all;
}

class ReconstructRun {
public:
    /// `ranks`: those that do it together; null: this process alone.
    ReconstructRun(const ReconstructArguments& arguments, Ranks* ranks)
        : arguments_(arguments),
          ranks_(ranks),
          clouds_(arguments.clouds()),
          levels_(arguments.level_range()),
          stages_(parse_stages(arguments.stages)),
          tiles_(ranks ? arguments.tiles_of_rank() : arguments.tiles()),
          options_(checked_options(arguments, levels_)),
          plan_(arguments, clouds_, levels_, stages_),
          text_(plan_.uses_standard_output() ? std::cerr : std::cout) {
        options_.measure = !arguments.quiet || !arguments.report.empty() || !arguments.html.empty();
        options_.classify = options_.measure || plan_.writes_features() || !stages_.empty();
        options_.vertex_normals = plan_.writes_properties();
    }

    int run() {
        const std::size_t inputs = clouds_.size();
        for (const CloudFiles& cloud : clouds_) {
            if (inputs == 1) {
                reconstruct_alone(cloud);
            } else {
                try_one(cloud);
            }
            text_ << std::flush; // what is done has been told, whatever comes
        }
        if (inputs > 1 && !arguments_.quiet)
            text_ << grouped(inputs - failed_inputs_) << " of " << grouped(inputs) << " inputs done, "
                  << grouped(failed_inputs_) << " failed, " << grouped(points_) << " points, "
                  << grouped(faces_) << " faces"
                  << (doubtful_ > 0 ? "; " + grouped(doubtful_) + " with warnings" : "") << '\n';
        write_report();
        return failed_inputs_ == 0 && !(arguments_.strict && doubtful_ > 0) ? done : failed;
    }

private:
    /// A failure is told and noted; the other inputs go on.
    void try_one(const CloudFiles& cloud) {
        try {
            reconstruct_one(cloud);
        } catch (const std::exception& error) {
            ++failed_inputs_;
            const std::string failure = message_of(error);
            complain(failure);
            note_failure(cloud.input, failure);
        }
    }

    /// A failure is noted in the report; whoever runs this tells it and knows the status that it deserves.
    void reconstruct_alone(const CloudFiles& cloud) {
        try {
            reconstruct_one(cloud);
        } catch (const std::exception& error) {
            if (arguments_.report.empty()) throw;
            const char *const file = current_file(), *const phase = current_phase();
            note_failure(cloud.input, message_of(error));
            try {
                write_report();
            } catch (const std::exception& second) {
                complain(message_of(second));
            }
            set_activity(file, phase);
            throw;
        }
    }

    void note_failure(const std::string& input, const std::string& failure) {
        JsonText json;
        json.begin_object();
        json.key("input");
        json.begin_object();
        json.member("file", input);
        json.end();
        json.member("failure", failure);
        json.end();
        reports_.push_back(std::move(json).take());
    }

    void reconstruct_one(const CloudFiles& cloud) {
        const std::string name = cloud.name();
        // A message may name it after this object's end.
        const std::string& input = *std::ranges::find(arguments_.inputs, cloud.input);
        set_activity(input == "-" ? "standard input" : input.c_str(), "read");
        bool complete = true;
        std::size_t points = 0; // of an input without a mesh none count
        for (const Report& report : make(cloud, name)) {
            if (tell(name, report))
                points = report.input.points;
            else
                complete = false;
        }
        points_ += points;
        failed_inputs_ += !complete;
    }

    /// Reads, reconstructs and writes one input.
    std::vector<Report> make(const CloudFiles& cloud, const std::string& name) {
        const auto start = Clock::now();
        ProgressBar bar(arguments_.progress, name);
        bar.show("read", 0);
        std::optional<PointFile> read;
        if (tiles_) {
            PointsInParts points(cloud.files, arguments_.read);
            const bool goes_on = arguments_.resume && KeptScratch::is_there(arguments_.scratch, 0);
            if (ranks_ || goes_on || !fits_in_one_piece(points.size())) {
                std::optional<std::vector<Report>> made = try_in_tiles(points, cloud, start, bar);
                if (made) return std::move(*made);
                if (!ranks_->is_first()) return {};
            }
            if (points.in_memory()) read = std::move(points).file();
        }
        PointFile file = read ? std::move(*read) : read_joined(cloud.files, arguments_.read);
        const double read_seconds = seconds_since(start);
        PointCloud scan = scan_for_stages(stages_, file.cloud, options_.measure);
        if (!arguments_.html.empty() && scan.positions.empty()) scan.positions = file.cloud.positions;
        ReconstructOptions options = options_;
        options.debug_dir = plan_.debug_dir(cloud.input);
        options.progress = shown_on(bar);
        const auto write_all = [&](std::span<Reconstruction> results) {
            bar.show(stages_.empty() ? "write" : "stages", 0.97);
            std::vector<Report> made;
            for (Reconstruction& result : results) {
                note_input(cloud, result.report);
                result.report.seconds.read = read_seconds;
                write_one(name, scan, result);
                result.report.seconds.total = seconds_since(start);
                write_page(scan.positions, result);
                made.push_back(std::move(result.report));
            }
            return made;
        };
        if (levels_) {
            std::vector<Reconstruction> results = named(cloud, [&] {
                return reconstruct_levels(std::move(file), levels_->first, levels_->second, options);
            });
            return write_all(results);
        }
        Reconstruction result = named(cloud, [&] { return reconstruct(std::move(file), options); });
        return write_all({&result, 1});
    }

    void note_input(const CloudFiles& cloud, Report& report) const {
        if (!refused_in_tiles_.empty()) {
            report.options["ranks"] = std::to_string(ranks_->size());
            report.options["tiles"] = "none, by the first rank alone: " + refused_in_tiles_;
        }
        report.input.file = cloud.input;
        if (arguments_.join) report.input.files = cloud.files;
    }

    bool fits_in_one_piece(std::size_t points) const {
        ReconstructOptions options = options_;
        if (levels_) options.depth = levels_->second;
        return hsdm::fits_in_one_piece(points, options, tiles_->memory);
    }

    static std::function<bool(const char*, double)> shown_on(ProgressBar& bar) {
        return [&bar](const char* phase, double share) {
            set_phase(phase);
            bar.show(phase, 0.1 + 0.85 * share);
            return true;
        };
    }

    /// Those asked for, less the memory that points take already.
    TileOptions tiles_beside(const PointsInParts& points, const CloudFiles& cloud) const {
        TileOptions tiles = *tiles_;
        const std::size_t held = points.in_memory() ? bytes_of_cloud(points.file().cloud) : 0;
        if (held >= tiles.memory)
            throw Error(cloud.name(),
                        "its points take " + std::to_string(held / 1000000)
                            + " MB once they are read; of binary PLY files they need not be in memory");
        tiles.memory -= held;
        return tiles;
    }

    /// The same in bounded memory, or nothing where several ranks find that it has to be done in one piece,
    /// which memory allows: by the first of them.
    std::optional<std::vector<Report>> try_in_tiles(const PointsInParts& points, const CloudFiles& cloud,
                                                    Clock::time_point start, ProgressBar& bar) {
        std::optional<KeptScratch> kept;
        if (!may_be_one_piece(points)) {
            arguments_.check_for_tiles(*tiles_);
            return make_in_tiles(points, cloud, start, kept, bar);
        }
        try {
            arguments_.check_for_tiles(*tiles_);
        } catch (const OptionError& refusal) { // by all ranks
            note_refusal(cloud, refusal.what());
            return std::nullopt;
        }
        try {
            return make_in_tiles(points, cloud, start, kept, bar);
        } catch (const RefusedInTiles& refusal) {
            ranks_->give_up(refusal.what());
            note_refusal(cloud, refusal.what());
        } catch (const OtherRankGaveUp& refusal) {
            note_refusal(cloud, refusal.what());
        }
        if (kept) kept->remove(); // all know that nothing goes on with it
        return std::nullopt;
    }
    bool may_be_one_piece(const PointsInParts& points) const {
        return ranks_ && (tiles_->memory == TileOptions::no_bound || fits_in_one_piece(points.size()));
    }
    /// But for the cloud's name and what could be done instead.
    void note_refusal(const CloudFiles& cloud, const std::string& what) {
        const std::size_t begin = what.starts_with(cloud.name() + ": ") ? cloud.name().size() + 2 : 0;
        refused_in_tiles_ = what.substr(begin, what.find("; ") - begin);
        if (const std::string of_option = "memory: "; refused_in_tiles_.starts_with(of_option))
            refused_in_tiles_.replace(0, of_option.size(), "it ");
    }

    /// The same in bounded memory. Reading is part of the other phases.
    std::vector<Report> make_in_tiles(const PointsInParts& points, const CloudFiles& cloud,
                                      Clock::time_point start, std::optional<KeptScratch>& kept,
                                      ProgressBar& bar) {
        const double read_seconds = seconds_since(start);
        ReconstructOptions options = options_;
        options.progress = shown_on(bar);
        TileOptions tiles = tiles_beside(points, cloud);
        OneRank alone;
        Ranks& ranks = ranks_ ? *ranks_ : alone;
        const PointParts parts = [&](const auto& visit) {
            points.visit_share(ranks.rank(), ranks.size(),
                               [&](const PointCloud& part) { visit(view_of(part)); });
        };
        const std::vector<std::uint64_t> seen = ranks.gather(points.fingerprint());
        if (std::ranges::count(seen, seen.front()) != ranks.size())
            throw Error(cloud.name(), "is not the same to all processes; put it where all of them see it");
        if (arguments_.resume) {
            refuse_moved(arguments_.scratch, ranks);
            kept.emplace(arguments_.scratch, ranks.rank(), arguments_.job(cloud, ranks.size()));
            tiles.kept = &*kept;
        }
        // Before there is a mesh in memory: what a run that goes on does not read is read for it.
        const bool goes_on = kept && ranks.any(!kept->records().empty());
        if (goes_on && ranks.is_first()) points.size();
        PointFile read = goes_on ? notes_of_all(points, ranks) : PointFile();
        TileReport how;
        std::size_t kept_tiles = 0; // of all ranks
        const auto note = [&](Report& report) {
            note_reading(read, report);
            if (!arguments_.memory.empty()) report.options["memory"] = arguments_.memory;
            report.options["tiles"] = std::to_string(how.tiles);
            if (how.went_on) report.options["resume"] = std::to_string(kept_tiles) + " tiles were kept";
            if (ranks_) {
                report.options["ranks"] = std::to_string(ranks_->size());
                report.ranks = std::move(how.ranks);
            }
            note_input(cloud, report);
            report.seconds.read = read_seconds;
            bar.show("write", 0.97);
        };
        const auto hear_of_all = [&] {
            if (!goes_on) read = notes_of_all(points, ranks);
            kept_tiles = ranks.sum(how.kept_tiles);
        };
        std::vector<Report> made;
        const auto make = [&] {
            if (is_written_as_it_comes()) {
                FlatReconstruction flat = named(
                    cloud, [&] { return reconstruct_flat_in_tiles(parts, options, tiles, ranks, &how); });
                hear_of_all();
                note(flat.report);
                write_as_it_comes(flat, ranks);
                if (ranks.is_first()) made.push_back(std::move(flat.report));
            } else {
                Reconstruction result =
                    named(cloud, [&] { return reconstruct_in_tiles(parts, options, tiles, ranks, &how); });
                hear_of_all();
                if (ranks.is_first()) {
                    note(result.report);
                    write_one(cloud.name(), {}, result);
                    made.push_back(std::move(result.report));
                }
            }
        };
        with_kept_told(kept, ranks, may_be_one_piece(points), make);
        if (kept) {
            ranks.any(false); // the mesh is written
            kept->remove();
        }
        if (ranks.is_first()) made.back().seconds.total = seconds_since(start);
        return made;
    }

    /// Is nothing wanted of the mesh that takes a half-edge mesh?
    bool is_written_as_it_comes() const {
        return arguments_.features.empty() && !arguments_.intersections && !arguments_.strict;
    }

    /// By all ranks, of which the first has all of it.
    void write_as_it_comes(FlatReconstruction& flat, Ranks& ranks) const {
        Report& report = flat.report;
        auto start = Clock::now();
        const WorkOfRanks work(ranks);
        if (!arguments_.report.empty() && ranks.is_first()) measure_details(flat.mesh, report.mesh);
        report.seconds.error += seconds_since(start);
        set_phase("write");
        start = Clock::now();
        const MeshTarget to = target(report);
        report.written = report_of(
            to, write_flat(to.mesh, flat, to.format, to.plain, {to.ascii, to.unit, to.recentre}, ranks));
        report.seconds.write = seconds_since(start);
        work.add_to(report.ranks);
    }

    static std::size_t bytes_of_cloud(const PointCloud& cloud) {
        return cloud.positions.size() * sizeof(Vec3) + cloud.normals.size() * sizeof(Vec3)
               + cloud.colors.size() * sizeof(cloud.colors.front())
               + cloud.scalars.size() * cloud.positions.size() * sizeof(double)
               + cloud.sensor_of.size() * sizeof(cloud.sensor_of.front());
    }

    MeshTarget target(const Report& report) const {
        return plan_.target(report.input.file,
                            levels_ ? std::optional<int>(report.grid.depth) : std::nullopt);
    }

    /// Adds what is told of a mesh, of these polygons, only if it is asked for.
    void measure_more(const PolygonMesh& polygons, Reconstruction& result) const {
        const auto start = Clock::now();
        if (!arguments_.report.empty() || !arguments_.html.empty())
            measure_details(polygons, result.report.mesh);
        if (arguments_.intersections || arguments_.strict) {
            set_phase("intersections");
            count_intersections(result.mesh, result.report);
        }
        result.report.seconds.error += seconds_since(start);
    }

    /// Runs the stages on one level and writes it; a failure does not stop the others.
    void write_one(const std::string& name, const PointCloud& scan, Reconstruction& result) const {
        Report& report = result.report;
        if (!report.failure.empty()) return;
        auto start = Clock::now();
        try {
            run_stages(name, stages_, scan, options_.measure, arguments_.quiet, result);
            PolygonMesh polygons = to_polygons(result.mesh);
            measure_more(polygons, result);
            set_phase("write");
            start = Clock::now();
            const MeshTarget to = target(report);
            report.written = report_of(to, write_outputs(to, result.mesh, std::move(polygons)));
        } catch (const std::exception& error) {
            if (!levels_) throw;
            report.failure = message_of(error);
        }
        report.seconds.write = seconds_since(start);
    }

    /// The page of a mesh that was written; last, for it tells how long all the rest took.
    void write_page(std::vector<Vec3> points, Reconstruction& result) const {
        Report& report = result.report;
        const std::string page = target(report).page;
        if (page.empty() || !report.failure.empty()) return;
        set_phase("page");
        std::erase_if(points, [](const Vec3& p) { return !is_finite(p); });
        const PolygonMesh mesh = to_polygons(result.mesh);
        try {
            write_text(
                page,
                page_of({.title = title_of(report), .mesh = mesh, .points = points, .report = &report}));
        } catch (const std::exception& error) {
            if (!levels_) throw;
            report.failure = message_of(error);
        }
    }

    std::string title_of(const Report& report) const {
        const std::string& file = report.input.file;
        const std::string name =
            file == "-" ? "Standard input" : std::filesystem::path(file).filename().string();
        return levels_ ? name + ", depth " + std::to_string(report.grid.depth) : name;
    }

    /// Notes the report and prints a line or a summary; false for a level that failed.
    bool tell(const std::string& name, const Report& report) {
        reports_.push_back(to_json(report));
        if (!report.failure.empty()) {
            complain(name + ", depth " + std::to_string(report.grid.depth) + ": " + report.failure);
            return false;
        }
        faces_ += report.mesh.faces;
        doubtful_ += !report.warnings.empty();
        if (!arguments_.quiet) print(report);
        if (arguments_.strict && !report.warnings.empty())
            complain(name + ": " + strict_words(report) + "; the mesh is written");
        return true;
    }

    void print(const Report& report) const {
        const std::string written = spoken_name(target(report).mesh);
        if (clouds_.size() == 1 && !levels_) {
            text_ << summary_of(report, written);
        } else {
            text_ << line_of(report, written);
        }
        if (report.written) text_ << written_words(*report.written);
        if (!refused_in_tiles_.empty())
            text_ << "ranks     the first one alone, in one piece: " << refused_in_tiles_ << '\n';
        else if (ranks_)
            text_ << work_words(report.ranks, arguments_.verbose);
        if (arguments_.verbose) text_ << details_of(report);
        text_ << warnings_of(report);
    }

    /// One mesh: its report; several: a list of them in the order they were made.
    void write_report() const {
        if (arguments_.report.empty() || (ranks_ && !ranks_->is_first())) return;
        set_activity(arguments_.report.c_str(), "write");
        if (clouds_.size() == 1 && !levels_) {
            write_text(arguments_.report, reports_.front());
            return;
        }
        std::string text = "[\n";
        for (std::size_t i = 0; i < reports_.size(); ++i)
            text += reports_[i] + (i + 1 < reports_.size() ? ",\n" : "");
        write_text(arguments_.report, text + "]\n");
    }

    const ReconstructArguments& arguments_;
    Ranks* ranks_;
    std::vector<CloudFiles> clouds_;
    std::optional<std::pair<int, int>> levels_;
    std::vector<StageCall> stages_;
    std::optional<TileOptions> tiles_;
    std::string refused_in_tiles_; // why; empty: it was not, or memory does not allow one piece
    ReconstructOptions options_;
    OutputPlan plan_;
    std::ostream& text_;
    std::vector<std::string> reports_;
    std::size_t failed_inputs_ = 0, points_ = 0, faces_ = 0;
    std::size_t doubtful_ = 0; // meshes with warnings
};

/// All ranks do the same up to the mesh, which the first has and writes.
int reconstruct_by(Ranks& ranks, ReconstructArguments& arguments) {
    if (!ranks.is_first()) arguments.progress = Progress::never;
    return ReconstructRun(arguments, &ranks).run();
}

} // namespace

void add_reconstruct(CLI::App& app, Run& run, Ranks* ranks) {
    CLI::App* const sub = app.add_subcommand("reconstruct", "point clouds in, meshes out");
    const auto arguments = std::make_shared<ReconstructArguments>();
    add_file_options(*sub, *arguments);
    add_method_options(*sub, *arguments);
    sub->footer("The mesh is an oriented 2-manifold, mostly of quads, with its sharp edges marked;\n"
                "outward where it is closed. What may be wrong with it is said in warnings.\n"
                "Examples:\n"
                "  hsdm reconstruct scan.ply -o part.stl\n"
                "  hsdm reconstruct scan.xyz --depth 6 -o part.off --features part.txt --report part.json\n"
                "  hsdm reconstruct scan.ply --levels 4:7 -o part.ply\n"
                "  hsdm reconstruct *.xyz --out-dir meshes --format stl\n"
                "  cat scan.xyz | hsdm reconstruct - --input-format xyz -o - --format off > part.off");
    sub->callback([&run, arguments, ranks] {
        run = [arguments, ranks] {
            if (arguments->threads > most_threads)
                complain("--threads " + std::to_string(arguments->threads) + ": "
                         + std::to_string(most_threads) + " are used, more would find nothing to do");
            if (arguments->threads > 0) bound_threads(std::min(arguments->threads, most_threads));
            return ranks ? reconstruct_by(*ranks, *arguments) : ReconstructRun(*arguments, nullptr).run();
        };
    });
}

} // namespace hsdm::command
