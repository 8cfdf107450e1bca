// hsdm process: a mesh through processing modules.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "messages.hh"
#include "module_watch.hh"
#include "reconstruct_output.hh"
#include "summary.hh"
#include "usage.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/modules/plugin_loader.hh"
#include "hsdm/point_cloud.hh"

#include <cmath>
#include <filesystem>
#include <iostream>

namespace hsdm::command {
namespace {

struct ProcessArguments {
    std::string input, output, format;
    std::vector<std::string> modules;
    bool list = false, ascii = false, quiet = false, in_place = false;
};

int list_modules() {
    const std::vector<PluginListing> modules = list_plugins();
    for (const PluginListing& module : modules) {
        if (!module.problem.empty()) {
            std::cout << printable(module.path) << ": cannot be used: " << printable(module.problem) << '\n';
            continue;
        }
        std::cout << printable(module.name + ": " + module.description + "; options: " + module.options)
                  << '\n';
    }
    if (!modules.empty()) return done;
    std::string places;
    for (const std::string& folder : plugin_folders()) places += (places.empty() ? "" : ", ") + folder;
    std::cout << "no processing module found in " << printable(places)
              << "; set HSDM_PLUGIN_PATH to their folder\n";
    return done;
}

using Step = std::pair<Plugin, PluginRequest>;

std::vector<Step> load_steps(const std::vector<std::string>& modules) {
    std::vector<Step> steps;
    for (const std::string& text : modules) {
        PluginRequest request = parse_plugin_request(text);
        Plugin plugin = load_plugin(request.name);
        steps.emplace_back(std::move(plugin), std::move(request));
    }
    return steps;
}

/// The claims of the mesh and of what is written in the end.
FileClaims mesh_claims(const ProcessArguments& a) {
    FileClaims claims;
    if (a.in_place) {
        claims.writes("--in-place " + a.input, a.input);
    } else {
        claims.reads("the mesh", a.input);
        claims.writes("-o " + a.output, a.output);
    }
    return claims;
}

/// Throws UsageError for an output that would destroy the mesh, unless that is what was asked for, or a
/// module.
void check_claims(const ProcessArguments& a, const std::vector<Step>& steps) {
    FileClaims claims = mesh_claims(a);
    try {
        claims.check();
    } catch (const UsageError& error) {
        if (a.input == "-") throw;
        throw UsageError(std::string(error.what()) + ", or overwrite the mesh with --in-place");
    }
    for (const Step& step : steps) claims.reads("the module", step.first.path());
    if (!a.quiet && !is_standard_output(a.in_place ? a.input : a.output)) claims.writes("the summary", "-");
    claims.check();
}

PolygonMesh read_input(const std::string& input) {
    set_activity(input.c_str(), "read");
    PolygonMesh facets = read_mesh(input);
    if (facets.facet_count() == 0)
        throw Error(input, "holds no faces; reconstruct a mesh from its points first");
    return facets;
}

/// Modules multiply lengths, so a mesh of extreme size is measured in a unit of its own, a power of two, for
/// them. Returns that unit.
double scale_for_modules(PolygonMesh& facets, const ProcessArguments& a) {
    const double unit = CloudFrame(bounds_of(facets.positions)).unit();
    if (unit == 1) return unit;
    for (Vec3& p : facets.positions) p /= unit;
    if (!a.quiet)
        complain(a.input + ": lengths, also those of the modules' options, are measured in units of 2^"
                 + std::to_string(std::ilogb(unit)));
    return unit;
}

ToMeshResult build(const std::string& input, const PolygonMesh& facets) {
    ToMeshResult built = to_mesh(facets);
    if (built.rejected > 0)
        complain(input + ": " + std::to_string(built.rejected)
                 + " facets were left out, which no 2-manifold can hold");
    mark_edges_by_normals(built.mesh);
    return built;
}

/// Throws Error that names the mesh too.
std::string process(const std::string& input, const Plugin& plugin, PolyMesh& mesh,
                    const PluginRequest& request) {
    try {
        const ModuleWatch watch(input + ": module " + plugin.name());
        return plugin.process(mesh, request.options);
    } catch (const Error& error) {
        throw Error(input, error.what());
    }
}

int run_process(const ProcessArguments& a) {
    if (a.list) return list_modules();
    if (a.in_place && a.input == "-")
        throw UsageError("--in-place writes the mesh's own file, and standard input has none; use -o FILE");
    std::error_code ignored;
    if (a.in_place && !a.output.empty() && !std::filesystem::equivalent(a.input, a.output, ignored))
        throw UsageError("--in-place writes the mesh's own file, and -o names another; leave one out");
    if (a.input.empty() || (a.output.empty() && !a.in_place) || a.modules.empty())
        throw UsageError("process needs a mesh, -o FILE or --in-place, and at least one --module NAME");
    const std::string& output = a.in_place ? a.input : a.output;
    const MeshFormat format = format_for(output, a.format);
    const std::vector<Step> steps = load_steps(a.modules);
    check_claims(a, steps);
    check_writable(output);
    PolygonMesh facets = read_input(a.input);
    const double unit = scale_for_modules(facets, a);
    ToMeshResult built = build(a.input, facets);
    facets = {};
    std::ostream& text = is_standard_output(output) ? std::cerr : std::cout;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const auto& [plugin, request] = steps[i];
        set_phase(a.modules[i].c_str());
        const std::string summary = process(a.input, plugin, built.mesh, request);
        if (!a.quiet) text << printable(plugin.name() + ": " + summary) << std::endl;
    }
    set_phase("write");
    if (unit != 1)
        for (const auto v : built.mesh.vertices()) built.mesh.set_point(v, built.mesh.point(v) * unit);
    if (format == MeshFormat::om) { // the one writer that would write what is deleted
        built.mesh.delete_isolated_vertices();
        built.mesh.garbage_collection();
    }
    MeshTarget target;
    target.mesh = output;
    target.format = format;
    target.ascii = a.ascii;
    const WrittenMesh written = write_outputs(target, built.mesh);
    if (written.text_for_precision && !a.quiet) text << text_for_precision;
    return done;
}

} // namespace

void add_process(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("process", "a mesh through processing modules loaded at run time");
    const auto a = std::make_shared<ProcessArguments>();
    sub->add_option("mesh", a->input, "OFF, STL, PLY, OBJ or .om");
    sub->add_option("-o,--output", a->output, "the mesh to write; - is standard output")->type_name("FILE");
    sub->add_flag("--in-place", a->in_place, "write the mesh's own file instead");
    sub->add_option("--format", a->format, "its format, where no extension names it")
        ->check(one_of({"off", "stl", "ply", "obj", "om"}))
        ->type_name("off|stl|ply|obj|om");
    sub->add_flag("--ascii", a->ascii, "text instead of binary STL and PLY");
    sub->add_option("--module", a->modules,
                    "NAME or NAME:key=value,key=value; several run in the order given")
        ->type_name("MODULE");
    sub->add_flag("--list", a->list, "the modules there are, and their options");
    sub->add_flag("--quiet", a->quiet, "no summary, errors only");
    sub->footer(
        "Modules are looked for in the folders of HSDM_PLUGIN_PATH, then in that of the installation, and\n"
        "refused if others could have written them.\nExamples:\n  hsdm process --list\n"
        "  hsdm process part.off --module classify-features --module smooth-normals -o part.ply");
    sub->callback([&run, a] { run = [a] { return run_process(*a); }; });
}

} // namespace hsdm::command
