#include "reconstruct_arguments.hh"

#include "usage.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/join_points.hh"
#include "hsdm/pipeline/kept_passes.hh"
#include "hsdm/version.hh"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

namespace hsdm::command {
namespace {

template <class T>
using Names = std::vector<std::pair<std::string, T>>;

const Names<Holes> words_of_holes{{"auto", Holes::automatic},
                                  {"keep", Holes::keep},
                                  {"close", Holes::close},
                                  {"complete", Holes::complete}};
const Names<Grid> words_of_grids{{"uniform", Grid::uniform}, {"adaptive", Grid::adaptive}};
const Names<Method> words_of_methods{
    {"auto", Method::automatic}, {"basic", Method::basic}, {"extended", Method::extended}};
const Names<NormalSource> words_of_normals{
    {"auto", NormalSource::automatic}, {"given", NormalSource::given}, {"estimate", NormalSource::estimate}};

/// Empty: the value has none.
template <class T>
std::string word_of(const Names<T>& names, T value) {
    for (const auto& [word, meaning] : names)
        if (meaning == value) return word;
    return {};
}

/// An option with a few named values.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value, const Names<T>& names,
                        const std::string& help) {
    std::string list;
    std::vector<std::string> known;
    for (const auto& [word, meaning] : names) {
        list += (list.empty() ? "" : "|") + word;
        known.push_back(word);
    }
    return app
        .add_option_function<std::string>(
            name,
            [&value, names](const std::string& given) {
                for (const auto& [word, meaning] : names)
                    if (word == given) value = meaning;
            },
            help)
        ->check(one_of(known))
        ->type_name(list)
        ->default_str(word_of(names, value));
}

constexpr int deepest = 16;
constexpr int largest = std::numeric_limits<int>::max();
constexpr double unbounded = std::numeric_limits<double>::infinity();

/// All digits of a number.
std::string exact(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.17g", value);
    return digits;
}

/// ply|pcd|...
std::string joined_formats() {
    return joined({point_formats().begin(), point_formats().end()}, "|");
}

/// "4G", "500MB", "2000000000": bytes, K, M, G and T being powers of 1000. Nothing if it is none.
std::optional<std::size_t> bytes_of(std::string text) {
    double factor = 1;
    if (text.ends_with('B') || text.ends_with('b')) text.pop_back();
    constexpr std::string_view prefixes = "KMGT";
    if (!text.empty())
        if (const auto k = prefixes.find(static_cast<char>(std::toupper(text.back()))); k != prefixes.npos) {
            factor = std::pow(1000.0, static_cast<double>(k + 1));
            text.pop_back();
        }
    double value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size() || !(value > 0) || value * factor > 1e18)
        return std::nullopt;
    return static_cast<std::size_t>(value * factor);
}

/// A number, or a percentage as a share.
struct Amount {
    double value = 0;
    bool is_share = false;
};

/// Nothing if the text is none, or not finite.
std::optional<Amount> amount_of(const std::string& text) {
    const bool is_share = text.ends_with('%');
    const auto value = number_of<double>(std::string_view(text).substr(0, text.size() - is_share));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return Amount{is_share ? *value / 100 : *value, is_share};
}

/// X,Y,Z; nothing if the text is not that.
std::optional<Vec3> place_of(std::string_view text) {
    Vec3 place;
    for (unsigned k = 0; k < 3; ++k) {
        const std::size_t comma = k < 2 ? text.find(',') : text.size();
        if (comma == std::string_view::npos) return std::nullopt;
        const auto value = number_of<double>(text.substr(0, comma));
        if (!value || !std::isfinite(*value)) return std::nullopt;
        place[k] = *value;
        text.remove_prefix(std::min(text.size(), comma + 1));
    }
    return place;
}

/// A number of facets, or with % a share of the largest component.
MinComponent min_component_of(const std::string& text) {
    const auto least = amount_of(text);
    if (!least || least->value < 0 || (least->is_share && least->value > 1))
        throw UsageError("--min-component " + text
                         + ": a number of facets or a percentage up to 100% is wanted, e.g. 200 or 1%");
    return {least->value, least->is_share};
}

/// A length, or with % a share of the bounding box's diagonal.
MaxError error_of(const std::string& text) {
    const auto error = amount_of(text);
    if (!error || !(error->value > 0))
        throw UsageError("--max-error " + text
                         + ": a length above 0 or a percentage is wanted, e.g. 0.2 or 0.1%");
    return {error->value, error->is_share};
}

/// What becomes of the surface's holes, layers and small parts.
void add_surface_options(CLI::App& app, ReconstructArguments& a, const std::string& method) {
    add_choice<Holes>(app, "--holes", a.holes, words_of_holes,
                      "auto: close what is small against the sampling, and slits as narrow; keep: nothing; "
                      "complete: everything, by the surface "
                      "that is missing; close: everything, over the vertices of its border")
        ->group(method);
    app.add_flag(
           "--confidence", a.confidence,
           "PLY and .om get hsdm_confidence, 0 to 1: how much of the surface around a vertex points show")
        ->group(method);
    app.add_option("--trim", a.trim,
                   "cut off the facets of less confidence, a share from 0 to 1; 0.3 leaves what was "
                   "measured (default: none)")
        ->type_name("SHARE")
        ->check(number_between(0, 1, "lie between 0 and 1"))
        ->group(method);
    app.add_flag("--merge-layers", a.merge_layers,
                 "for scans that do not register: sheets in a voxel that face the same way are one surface")
        ->group(method);
    app.add_option("--min-component", a.min_component,
                   "drop components of fewer facets than SIZE (1% is of the largest one's area; 100% keeps "
                   "the largest alone; default: none is dropped)")
        ->type_name("SIZE")
        ->group(method);
}

} // namespace

void add_method_options(CLI::App& app, ReconstructArguments& a) {
    const std::string resolution = "Resolution (default: chosen from the spacing and noise of the points)";
    const auto depth = app.add_option("--depth", a.depth,
                                      "octree depth N over the bounding cube, 1 to 16: voxel = "
                                      "largest extent / 2^N")
                           ->check(whole_number(1, deepest, "a whole number from 1 to 16"))
                           ->type_name("N")
                           ->group(resolution);
    const auto voxel = app.add_option("--voxel-size", a.voxel_size, "edge of a voxel in the cloud's units")
                           ->check(number_between(0, unbounded, "be a length above 0"))
                           ->type_name("L")
                           ->group(resolution);
    const auto error = app.add_option("--max-error", a.max_error,
                                      "adaptive: subdivide until the surface is within E of the points (the "
                                      "cloud's units; 0.1% is of the bounding box's diagonal)")
                           ->type_name("E")
                           ->group(resolution);
    const auto levels = app.add_option("--levels", a.levels,
                                       "one octree, one mesh per depth A to B: name.dA.off ... name.dB.off")
                            ->type_name("A:B")
                            ->group(resolution);
    const std::vector<CLI::Option*> resolutions{depth, voxel, error, levels};
    for (CLI::Option* one : resolutions)
        for (CLI::Option* other : resolutions)
            if (one != other) one->excludes(other);
    add_choice<Grid>(
        app, "--grid", a.grid, words_of_grids,
        "adaptive without --max-error keeps a tenth of a voxel (default: uniform, with --max-error adaptive)")
        ->group(resolution);

    const std::string method = "Method";
    add_choice<Method>(
        app, "--method", a.method, words_of_methods,
        "basic: from the positions alone; extended: with normals, given or estimated; auto: extended")
        ->group(method);
    add_choice<NormalSource>(app, "--normals", a.normals, words_of_normals,
                             "where normals come from; auto: the file's if it has some, else estimated")
        ->group(method);
    add_surface_options(app, a, method);
    app.add_option("--crease-degrees", a.crease_degrees,
                   "dihedral angle above which an edge is sharp, in degrees")
        ->check(number_between(0, 180, "lie between 0 and 180"))
        ->type_name("D")
        ->capture_default_str()
        ->group(method);
    app.add_option("--smoothing", a.smoothing, "rounds of anisotropic normal smoothing")
        ->check(whole_number(0, largest, "a whole number, 0 or more"))
        ->type_name("N")
        ->capture_default_str()
        ->group(method);
    app.add_option(
           "--stage", a.stages,
           "what the mesh goes through then: NAME or NAME:key=value,key=value; several run in the order "
           "given, hsdm stages names them (default: none)")
        ->type_name("STAGE")
        ->group(method);
    app.add_flag("--strict", a.strict,
                 "a warning is a failure: status 1, though files are written; counts intersections")
        ->group(method);
    app.add_option(
           "--memory", a.memory,
           "bytes (or 500M, 4G) of memory that are used at most: points lie sorted on disk and are worked "
           "through in tiles, with the same result (default: no bound)")
        ->type_name("SIZE")
        ->group(method);
    app.add_option("--scratch", a.scratch,
                   "the folder for these points, 48 bytes each, and 75 more while normals are estimated "
                   "(default: TMPDIR, or /tmp)")
        ->type_name("DIR")
        ->group(method);
    app.add_flag("--resume", a.resume,
                 "what is done stays in --scratch until the mesh is written, and a run of the same files and "
                 "options goes on with it")
        ->group(method);
}

void add_text_options(CLI::App& app, ReconstructArguments& a) {
    const std::string files = "Files";
    app.add_option("--input-format", a.read.format,
                   "the input's format (default: by its extension or content)")
        ->check(one_of({point_formats().begin(), point_formats().end()}))
        ->type_name(joined_formats())
        ->group(files);
    app.add_option_function<std::vector<std::string>>(
           "--sensor",
           [&a](const std::vector<std::string>& given) {
               for (const std::string& text : given) a.read.sensors.push_back(*place_of(text));
           },
           "where a scanner stood, in the cloud's units; several with --sensor-column, the first one's "
           "number "
           "is 0 (default: what the file says)")
        ->type_name("X,Y,Z")
        ->check(CLI::Validator(
            [](std::string& text) {
                return place_of(text) ? std::string()
                                      : text + ": must be three numbers with commas between them";
            },
            ""))
        ->expected(1)
        ->allow_extra_args(false) // the next word is an input
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(files);
    app.add_option("--sensor-column", a.read.sensor_column,
                   "the column that says which scanner saw a point (default: none)")
        ->type_name("NAME")
        ->group(files);
    app.add_option("--columns", a.read.columns,
                   "columns of a text file, e.g. x,y,z,nx,ny,nz,r,g,b,_ (default: by its header or values)")
        ->type_name("LIST")
        ->group(files);
}

void add_writing_options(CLI::App& app, ReconstructArguments& a) {
    const std::string files = "Files";
    app.add_flag("--ascii", a.ascii, "text instead of binary STL and PLY")->group(files);
    app.add_flag("--plain", a.plain, "positions and facets only: no normals, no vertex properties")
        ->group(files);
}

void add_file_options(CLI::App& app, ReconstructArguments& a) {
    app.add_option(
           "input", a.inputs,
           "point files (--input-format names the formats; of meshes the vertices); - is standard input")
        ->required()
        ->type_name("INPUT...");
    const std::string files = "Files";
    app.add_flag("--join", a.join,
                 "the inputs are scans of one thing: they become one cloud and one mesh; a folder stands for "
                 "its files of points")
        ->group(files);
    app.add_option("-o,--output", a.output, "the mesh; its extension names the format; - is standard output")
        ->type_name("FILE")
        ->group(files);
    app.add_option("--out-dir", a.out_dir, "one mesh per input, by the input's name; made if missing")
        ->type_name("DIR")
        ->group(files);
    app.add_option("--format", a.format, "the mesh's format, where no extension names it (default: off)")
        ->check(one_of(mesh_format_names()))
        ->type_name(joined(mesh_format_names(), "|"))
        ->group(files);
    add_writing_options(app, a);
    add_choice<LengthUnit>(
        app, "--units", a.units,
        {{"mm", LengthUnit::millimetre},
         {"cm", LengthUnit::centimetre},
         {"m", LengthUnit::metre},
         {"in", LengthUnit::inch}},
        "what the cloud's lengths are in: 3MF says so, GLB becomes metres (default: not said)")
        ->group(files);
    app.add_flag("--recentre", a.recentre,
                 "write coordinates relative to a shift, which summary and report tell: far from the origin "
                 "binary STL is too coarse otherwise")
        ->group(files);
    app.add_option("--features", a.features,
                   "sharp edges and corners: .dxf and .obj as lines and points, others as text (x y z x y z, "
                   "c x y z)")
        ->type_name("FILE")
        ->group(files);
    app.add_option("--report", a.report, "counts, errors and times as JSON; - is standard output")
        ->type_name("FILE")
        ->group(files);
    app.add_option(
           "--html", a.html,
           "a page to look at: the mesh to turn, deviations of the points, warnings, the report in words")
        ->type_name("FILE")
        ->group(files);
    app.add_flag("--intersections", a.intersections,
                 "count facets that pass through each other, for summary and report; takes its time")
        ->group(files);
    app.add_option("--debug-dir", a.debug_dir, "write the phases (voxels, graph, facets) as files here")
        ->type_name("DIR")
        ->group(files);

    add_text_options(app, a);

    const std::string running = "Running";
    app.add_option("--threads", a.threads, "at most N threads; the result is the same (default: all)")
        ->check(whole_number(0, largest, "a whole number, 0 (all) or more"))
        ->type_name("N")
        ->group(running);
    const auto quiet = app.add_flag("--quiet", a.quiet, "no summary, errors only")->group(running);
    app.add_flag("--verbose", a.verbose, "seconds of every phase, what was rejected")
        ->excludes(quiet)
        ->group(running);
    add_choice<Progress>(
        app, "--progress", a.progress,
        {{"auto", Progress::automatic}, {"always", Progress::always}, {"never", Progress::never}},
        "a bar on standard error; auto: on a terminal, for work over a second")
        ->group(running);
}

ReconstructOptions ReconstructArguments::options() const {
    if (normals == NormalSource::estimate && method == Method::basic)
        throw UsageError("--normals estimate: the basic method uses no normals; use --method extended");
    if (!max_error.empty() && grid == Grid::uniform)
        throw UsageError("--max-error " + max_error
                         + ": a uniform grid has no bound to keep; use --grid adaptive");
    ReconstructOptions o;
    o.depth = depth;
    o.voxel_size = voxel_size;
    if (!max_error.empty()) o.max_error = error_of(max_error);
    o.grid = grid;
    o.method = method;
    o.normals = normals;
    o.holes = holes;
    o.confidence = confidence;
    o.trim = trim;
    o.merge_layers = merge_layers;
    if (!min_component.empty()) o.min_component = min_component_of(min_component);
    o.crease_angle = crease_degrees * std::numbers::pi / 180;
    o.normal_smoothing = smoothing;
    o.threads = threads;
    o.debug_dir = debug_dir;
    return o;
}

void ReconstructArguments::check_resume() const {
    if (!resume) return;
    if (scratch.empty()) throw UsageError("--resume: give --scratch DIR, where what is done stays");
    if ((inputs.size() > 1 && !join) || inputs.front() == "-")
        throw UsageError("--resume: is of one cloud, of files; give one input, or --join scans of one thing");
}

std::vector<KeptScratch::Trait> ReconstructArguments::job(const CloudFiles& cloud, int processes) const {
    std::vector<KeptScratch::Trait> job{{"version of hsdm", version}, {"build of hsdm", form_of_kept()}};
    for (const std::string& file : cloud.files) {
        std::error_code failed;
        const std::string path = std::filesystem::weakly_canonical(file, failed).string();
        os::FileStatus status;
        if (failed || !os::status_of(file, status)) throw Error(file, "cannot be looked at");
        job.push_back({"input", path});
        job.push_back({"size of " + path, std::to_string(status.size) + " bytes"});
        job.push_back({"time of " + path, std::to_string(status.modified) + " ns since 1970"});
    }
    const auto add = [&](const char* name, const std::string& value) {
        job.push_back({name, value.empty() ? "none" : value});
    };
    add("number of processes", std::to_string(processes));
    add("--depth", depth ? std::to_string(*depth) : "");
    add("--voxel-size", voxel_size ? exact(*voxel_size) : "");
    add("--normals", word_of(words_of_normals, normals));
    add("--holes", word_of(words_of_holes, holes));
    add("--method", word_of(words_of_methods, method));
    add("--grid", word_of(words_of_grids, grid));
    add("--crease-degrees", exact(crease_degrees));
    add("--smoothing", std::to_string(smoothing));
    add("--input-format", read.format);
    add("--columns", read.columns);
    add("--sensor-column", read.sensor_column);
    std::string sensors;
    for (const Vec3& place : read.sensors)
        for (const double x : place) sensors += exact(x) + " ";
    add("--sensor", sensors);
    return job;
}

std::optional<TileOptions> ReconstructArguments::tiles() const {
    if (memory.empty()) {
        if (!scratch.empty())
            throw UsageError("--scratch " + scratch + ": is used with --memory alone; give that");
        if (resume) throw UsageError("--resume: is used with --memory alone; give that");
        return std::nullopt;
    }
    check_resume();
    const std::optional<std::size_t> bytes = bytes_of(memory);
    if (!bytes) throw UsageError("--memory " + memory + ": must be a number of bytes, or as 500M or 4G");
    TileOptions tiles;
    tiles.memory = *bytes;
    tiles.scratch = scratch;
    return tiles;
}

TileOptions ReconstructArguments::tiles_of_rank() const {
    if (inputs.size() > 1 && !join)
        throw UsageError("several ranks do one input at a time; give one, or --join scans of one thing");
    if (inputs.front() == "-" || output == "-")
        throw UsageError("several ranks have no standard input and output in common; give names of files");
    if (!memory.empty()) return *tiles();
    check_resume();
    TileOptions without_bound;
    without_bound.scratch = scratch;
    without_bound.memory = TileOptions::no_bound;
    return without_bound;
}

void ReconstructArguments::check_for_tiles(const TileOptions& tiles) const {
    for (const auto& [given, option] :
         {std::pair(!levels.empty(), "--levels"), {!stages.empty(), "--stage"}, {!html.empty(), "--html"}})
        if (given) throw UsageError(std::string("--memory cannot come with ") + option + " yet");
    check_options(options(), tiles);
}

std::string CloudFiles::name() const {
    if (files.size() > 1) return input + " (" + std::to_string(files.size()) + " files)";
    return input == "-" ? "standard input" : input;
}

std::vector<CloudFiles> ReconstructArguments::clouds() const {
    std::vector<CloudFiles> clouds;
    for (const std::string& input : inputs) {
        if (!join || clouds.empty()) clouds.push_back({input, {}});
        std::vector<std::string>& files = clouds.back().files;
        if (join && input == "-")
            throw UsageError("--join: standard input cannot be one of them; give files");
        os::FileStatus status;
        if (join && os::status_of(input, status) && status.kind == os::FileStatus::Kind::folder)
            for (std::string& file : point_files_in(input)) files.push_back(std::move(file));
        else
            files.push_back(input);
    }
    return clouds;
}

std::optional<std::pair<int, int>> ReconstructArguments::level_range() const {
    if (levels.empty()) return std::nullopt;
    const std::string_view text = levels;
    const std::size_t colon = std::min(text.find(':'), text.size() - 1);
    const auto first = number_of<int>(text.substr(0, colon)), last = number_of<int>(text.substr(colon + 1));
    if (!first || !last)
        throw UsageError("--levels " + levels
                         + ": two depths with a colon between them are wanted, e.g. 4:7");
    if (*first < 1 || *last > deepest || *first > *last)
        throw UsageError("--levels " + levels + ": must be two depths from 1 to 16, the lesser one first");
    return std::pair(*first, *last);
}

CaseOptions case_options(const std::string& name, const std::vector<std::string>& words) {
    CLI::App app("", "a case");
    ReconstructArguments arguments;
    add_method_options(app, arguments);
    add_text_options(app, arguments);
    add_writing_options(app, arguments);
    std::vector<std::string> last_first(words.rbegin(), words.rend()); // as CLI11 takes them
    try {
        app.parse(last_first);
    } catch (const CLI::ParseError& error) {
        throw Error(name, "args: " + fault_of(app, error));
    }
    if (!arguments.levels.empty()) throw Error(name, "args: --levels makes several meshes; give one --depth");
    if (!arguments.memory.empty() || !arguments.scratch.empty() || arguments.resume)
        throw Error(name, "args: --memory, --scratch and --resume are for hsdm reconstruct; leave them out");
    try {
        return {arguments.options(), arguments.read,  arguments.stages,
                arguments.strict,    arguments.ascii, arguments.plain};
    } catch (const UsageError& error) {
        throw Error(name, error.what());
    }
}

} // namespace hsdm::command
