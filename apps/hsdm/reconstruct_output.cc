#include "reconstruct_output.hh"

#include "page.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/write_features.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/phase_geometry.hh"

#include <cerrno>
#include <cstring>
#include <filesystem>
namespace hsdm::command {
namespace {

namespace fs = std::filesystem;

std::string extension(MeshFormat format) {
    return std::string(".").append(info_of(format).name);
}

/// .om has every property; its writer takes the mesh as it is.
void write_all_om(const std::string& path, const PolyMesh& mesh, const Vec3& shift) {
    if (shift == Vec3(0, 0, 0)) return write_om(path, mesh);
    PolyMesh near = mesh;
    for (const auto v : near.vertices()) near.set_point(v, near.point(v) - shift);
    write_om(path, near);
}

bool is_file(const std::string& path) {
    return find_target(path).kind == OutputTarget::Kind::file;
}

/// part.off -> part.d5.off; a pipe or device takes every level.
std::string with_depth(const std::string& path, std::optional<int> depth) {
    if (!depth || !is_file(path)) return path;
    fs::path result(path);
    const fs::path suffix = result.extension();
    result.replace_extension(".d" + std::to_string(*depth) + suffix.string());
    return result.string();
}

std::string stem(const std::string& input) {
    if (input == "-") return "stdin";
    std::error_code error;
    if (!fs::is_directory(input, error)) return fs::path(input).stem().string();
    fs::path folder = fs::weakly_canonical(input, error); // "scans/" and "." do not end with their names
    if (!folder.has_filename()) folder = folder.parent_path();
    return folder.has_filename() ? folder.filename().string() : "scans";
}

void make_folder(const std::string& folder) {
    if (folder.empty()) return;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder, error))
        throw Error(folder, "the folder cannot be made" + (error ? ": " + error.message() : std::string())
                                + "; check the permissions of the one above");
    if (!os::may_write_into(folder))
        throw Error(folder, std::string("the folder cannot be written: ") + std::strerror(errno)
                                + "; check its permissions");
}

} // namespace

MeshFormat format_for(const std::string& output, const std::string& format) {
    if (!format.empty()) return mesh_format("x." + format);
    if (output.empty() || output == "-") return MeshFormat::off;
    try {
        return mesh_format(output);
    } catch (const Error& error) {
        if (!fs::path(output).has_extension() && !is_file(output)) return MeshFormat::off;
        throw UsageError(std::string(error.what()) + "; or name the format with --format");
    }
}

OutputPlan::OutputPlan(const ReconstructArguments& arguments, const std::vector<CloudFiles>& clouds,
                       std::optional<std::pair<int, int>> levels, const std::vector<StageCall>& stages)
    : arguments_(arguments),
      meshes_(clouds.size()),
      levels_(levels),
      format_(format_for(arguments.output, arguments.format)) {
    check_combinations();
    check_claims(clouds, stages);
    make_folders();
    for (const std::string* path :
         {&arguments.output, &arguments.report, &arguments.features, &arguments.html})
        if (!path->empty()) check_writable(*path);
}

void OutputPlan::check_combinations() const {
    const ReconstructArguments& a = arguments_;
    if (a.output.empty() == a.out_dir.empty())
        throw UsageError("one of -o FILE and --out-dir DIR says where the mesh goes");
    if (a.intersections && a.quiet && a.report.empty())
        throw UsageError("--intersections: with --quiet only --report FILE tells them; give it too");
    if (meshes_ > 1 && !a.output.empty())
        throw UsageError("-o FILE holds one mesh; with several inputs use --out-dir DIR, or --join "
                         "scans of one thing");
    if (meshes_ > 1 && !a.features.empty())
        throw UsageError("--features FILE holds one mesh's; run the inputs one by one");
    if (meshes_ > 1 && !a.html.empty())
        throw UsageError("--html FILE shows one mesh; run the inputs one by one");
    if (!a.html.empty() && !can_write_pages()) throw UsageError("--html: " + std::string(without_three));
    if (levels_ && (a.output == "-" || a.features == "-" || a.html == "-"))
        throw UsageError("--levels makes several files; standard output holds one");
}

void OutputPlan::check_claims(const std::vector<CloudFiles>& clouds,
                              const std::vector<StageCall>& stages) const {
    FileClaims claims;
    claim_stage_files(stages, claims);
    for (const CloudFiles& cloud : clouds) {
        for (const std::string& file : cloud.files) claims.reads("the input", file);
        claim_outputs(cloud.input, claims);
    }
    if (!arguments_.report.empty()) claims.writes("--report " + arguments_.report, arguments_.report);
    if (!arguments_.quiet && !uses_standard_output()) claims.writes("the summary", "-");
    claims.check();
}

void OutputPlan::claim_outputs(const std::string& input, FileClaims& claims) const {
    const ReconstructArguments& a = arguments_;
    const auto [first, last] = levels_.value_or(std::pair(0, 0));
    for (int depth = first; depth <= last; ++depth) {
        const MeshTarget made = target(input, levels_ ? std::optional(depth) : std::nullopt);
        claims.writes(a.output.empty() ? "--out-dir " + a.out_dir : "-o " + a.output, made.mesh);
        if (!made.features.empty()) claims.writes("--features " + a.features, made.features);
        if (!made.page.empty()) claims.writes("--html " + a.html, made.page);
    }
    const std::string folder = debug_dir(input);
    if (folder.empty()) return;
    const auto depths = levels_ ? *levels_ : std::pair(a.depth.value_or(1), a.depth.value_or(deepest_level));
    for (int depth = depths.first; depth <= depths.second; ++depth) {
        const PhaseFiles files = phase_files(folder, depth);
        for (const std::string& file : {files.voxels, files.graph, files.facets})
            claims.writes("--debug-dir " + a.debug_dir, file);
    }
}

void OutputPlan::make_folders() const {
    make_folder(arguments_.out_dir);
    make_folder(arguments_.debug_dir);
}

std::string OutputPlan::debug_dir(const std::string& input) const {
    if (arguments_.debug_dir.empty() || meshes_ == 1) return arguments_.debug_dir;
    return (fs::path(arguments_.debug_dir) / stem(input)).string();
}

MeshTarget OutputPlan::target(const std::string& input, std::optional<int> depth) const {
    MeshTarget result;
    result.format = format_;
    result.ascii = arguments_.ascii;
    result.plain = arguments_.plain;
    result.unit = arguments_.units;
    result.recentre = arguments_.recentre;
    result.mesh = arguments_.output.empty()
                      ? (fs::path(arguments_.out_dir) / (stem(input) + extension(format_))).string()
                      : arguments_.output;
    if (result.mesh != "-") result.mesh = with_depth(result.mesh, depth);
    if (!arguments_.features.empty()) result.features = with_depth(arguments_.features, depth);
    if (!arguments_.html.empty()) result.page = with_depth(arguments_.html, depth);
    return result;
}

bool OutputPlan::writes_properties() const {
    return !arguments_.plain && info_of(format_).holds_normals;
}

bool OutputPlan::writes_features() const {
    return writes_properties() || !arguments_.features.empty();
}

bool OutputPlan::uses_standard_output() const {
    return is_standard_output(arguments_.output) || is_standard_output(arguments_.report)
           || is_standard_output(arguments_.features) || is_standard_output(arguments_.html);
}

namespace {

PolygonMesh plain_if_asked(PolygonMesh polygons, bool plain) {
    if (plain) {
        polygons.normals.clear();
        polygons.properties.clear();
        polygons.sharp_edges.clear();
    }
    return polygons;
}

} // namespace

PolygonMesh polygons_to_write(const PolyMesh& mesh, bool plain) {
    return plain_if_asked(to_polygons(mesh), plain);
}

Report::Written report_of(const MeshTarget& target, const WrittenMesh& written) {
    Report::Written told;
    told.format = info_of(target.format).name;
    told.units = name_of(target.unit);
    told.text_for_precision = written.text_for_precision;
    told.moved_by_floats = written.moved_by_floats;
    told.shift = written.shift;
    told.by_all_ranks = written.by_all_ranks;
    return told;
}

WrittenMesh write_outputs(const MeshTarget& target, const PolyMesh& mesh) {
    return write_outputs(target, mesh, to_polygons(mesh));
}

WrittenMesh write_outputs(const MeshTarget& target, const PolyMesh& mesh, PolygonMesh polygons) {
    polygons = plain_if_asked(std::move(polygons), target.plain);
    const WriteOptions options{target.ascii, target.unit, target.recentre};
    WrittenMesh written;
    if (target.format == MeshFormat::om && !target.plain) {
        if (target.recentre) written.shift = recentring_shift(polygons.positions);
        write_all_om(target.mesh, mesh, written.shift);
    } else {
        written = write_mesh(target.mesh, polygons, target.format, options);
    }
    if (!target.features.empty())
        write_features(target.features, mesh, feature_format(target.features), target.unit, written.shift);
    return written;
}

} // namespace hsdm::command
