#include "reconstruct_output.hh"

#include "hsdm/errors.hh"
#include "hsdm/facets/to_mesh.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/write_om.hh"

#include <filesystem>
#include <set>
#include <unistd.h>

namespace hsdm::command {
namespace {

namespace fs = std::filesystem;

std::string extension(MeshFormat format) {
    switch (format) {
    case MeshFormat::stl:
        return ".stl";
    case MeshFormat::ply:
        return ".ply";
    case MeshFormat::obj:
        return ".obj";
    case MeshFormat::om:
        return ".om";
    default:
        return ".off";
    }
}

/// part.off -> part.d5.off
std::string with_depth(const std::string& path, std::optional<int> depth) {
    if (!depth) return path;
    fs::path result(path);
    const fs::path suffix = result.extension();
    result.replace_extension(".d" + std::to_string(*depth) + suffix.string());
    return result.string();
}

std::string stem(const std::string& input) {
    return input == "-" ? "stdin" : fs::path(input).stem().string();
}

void check_writable(const std::string& path) {
    if (path.empty() || path == "-") return;
    if (fs::is_directory(path)) throw Error(path, "is a folder; name a file in it");
    fs::path folder = fs::path(path).parent_path();
    if (folder.empty()) folder = ".";
    if (!fs::is_directory(folder)) throw Error(path, "the folder does not exist; make it first");
    if (access(folder.c_str(), W_OK) != 0)
        throw Error(path, "the folder cannot be written; check its permissions");
}

} // namespace

OutputPlan::OutputPlan(const ReconstructArguments& arguments) : arguments_(arguments) {
    check_combinations();
    check_inputs();
    const ReconstructArguments& a = arguments_;
    const bool named_by_option = !a.format.empty() || a.output == "-" || a.output.empty();
    const std::string name = named_by_option ? "x." + (a.format.empty() ? "off" : a.format) : a.output;
    try {
        format_ = mesh_format(name);
    } catch (const Error& error) {
        throw UsageError(std::string(error.what()) + "; or name the format with --format");
    }
    check_folders();
}

void OutputPlan::check_combinations() const {
    const ReconstructArguments& a = arguments_;
    if (a.output.empty() == a.out_dir.empty())
        throw UsageError("one of -o FILE and --out-dir DIR says where the mesh goes");
    if (a.inputs.size() > 1 && !a.output.empty())
        throw UsageError("-o FILE holds one mesh; with several inputs use --out-dir DIR");
    if (a.inputs.size() > 1 && !a.features.empty())
        throw UsageError("--features FILE holds one mesh's; run the inputs one by one");
    if (!a.levels.empty() && (a.output == "-" || a.features == "-"))
        throw UsageError("--levels makes several files; standard output holds one");
    const int on_standard_output = (a.output == "-") + (a.report == "-") + (a.features == "-");
    if (on_standard_output > 1) throw UsageError("only one of the outputs can go to standard output");
}

void OutputPlan::check_inputs() const {
    std::set<std::string> written;
    for (const std::string& input : arguments_.inputs) {
        if (!arguments_.out_dir.empty() && !written.insert(stem(input)).second)
            throw UsageError("two inputs would both be written as " + stem(input) + " in "
                             + arguments_.out_dir + "; run them into folders of their own");
        std::error_code ignored;
        for (const std::string* output : {&arguments_.output, &arguments_.report, &arguments_.features})
            if (!output->empty() && fs::equivalent(input, *output, ignored))
                throw UsageError(*output + " is the input; writing there would destroy it");
    }
}

void OutputPlan::check_folders() const {
    const ReconstructArguments& a = arguments_;
    if (!a.out_dir.empty()) {
        std::error_code error;
        fs::create_directories(a.out_dir, error);
        if (error || !fs::is_directory(a.out_dir)) throw Error(a.out_dir, "the folder cannot be made");
        if (access(a.out_dir.c_str(), W_OK) != 0)
            throw Error(a.out_dir, "the folder cannot be written; check its permissions");
    }
    for (const std::string* path : {&a.output, &a.report, &a.features}) check_writable(*path);
    if (a.out_dir.empty()) return;
    for (const std::string& input : a.inputs) {
        const std::string mesh = target(input, std::nullopt).mesh;
        std::error_code ignored;
        if (fs::equivalent(input, mesh, ignored))
            throw UsageError(mesh + " is the input; writing there would destroy it");
    }
}

MeshTarget OutputPlan::target(const std::string& input, std::optional<int> depth) const {
    MeshTarget result;
    result.format = format_;
    result.ascii = arguments_.ascii;
    result.plain = arguments_.plain;
    result.mesh = arguments_.output.empty()
                      ? (fs::path(arguments_.out_dir) / (stem(input) + extension(format_))).string()
                      : arguments_.output;
    if (result.mesh != "-") result.mesh = with_depth(result.mesh, depth);
    if (!arguments_.features.empty()) result.features = with_depth(arguments_.features, depth);
    return result;
}

bool OutputPlan::writes_properties() const {
    return !arguments_.plain && format_ != MeshFormat::off && format_ != MeshFormat::stl;
}

bool OutputPlan::writes_features() const {
    return writes_properties() || !arguments_.features.empty();
}

bool OutputPlan::uses_standard_output() const {
    return arguments_.output == "-" || arguments_.report == "-" || arguments_.features == "-";
}

void write_outputs(const MeshTarget& target, const PolyMesh& mesh) {
    WriteOptions options;
    options.ascii = target.ascii;
    if (target.format == MeshFormat::om && target.mesh != "-" && !target.plain) {
        write_om(target.mesh, mesh); // with status bits and every property
    } else {
        PolygonMesh polygons = to_polygons(mesh);
        if (target.plain) {
            polygons.normals.clear();
            polygons.properties.clear();
        }
        write_mesh(target.mesh, polygons, target.format, options);
    }
    if (!target.features.empty()) write_text(target.features, feature_lines(mesh));
}

} // namespace hsdm::command
