// hsdm process: a mesh through processing modules.

#include "command.hh"
#include "interrupt.hh"

#include "hsdm/errors.hh"
#include "hsdm/facets/to_mesh.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/plugin_loader.hh"

#include <iostream>

namespace hsdm::command {
namespace {

struct ProcessArguments {
    std::string input, output, format;
    std::vector<std::string> modules;
    bool list = false, ascii = false, quiet = false;
};

int list_modules() {
    const std::vector<PluginListing> modules = list_plugins();
    for (const PluginListing& module : modules) {
        if (!module.problem.empty()) {
            std::cout << module.path << ": cannot be used: " << module.problem << '\n';
            continue;
        }
        std::cout << module.name << ": " << module.description << "; options: " << module.options << '\n';
    }
    if (modules.empty()) std::cout << "no processing module found; set HSDM_PLUGIN_PATH to their folder\n";
    return done;
}

MeshFormat output_format(const ProcessArguments& a) {
    try {
        if (!a.format.empty()) return mesh_format("x." + a.format);
        return a.output == "-" ? MeshFormat::off : mesh_format(a.output);
    } catch (const Error& error) {
        throw UsageError(std::string(error.what()) + "; or name the format with --format");
    }
}

int run_process(const ProcessArguments& a) {
    if (a.list) return list_modules();
    if (a.input.empty() || a.output.empty() || a.modules.empty())
        throw UsageError("process needs a mesh, -o FILE and at least one --module NAME");
    const MeshFormat format = output_format(a);
    std::vector<std::pair<Plugin, PluginRequest>> steps;
    for (const std::string& text : a.modules) {
        PluginRequest request = parse_plugin_request(text);
        Plugin plugin = load_plugin(request.name);
        steps.emplace_back(std::move(plugin), std::move(request));
    }
    const PolygonMesh facets = read_mesh(a.input);
    if (facets.facet_count() == 0)
        throw Error(a.input, "holds no faces; reconstruct a mesh from its points first");
    ToMeshResult built = to_mesh(facets);
    std::ostream& text = a.output == "-" ? std::cerr : std::cout;
    if (built.rejected > 0)
        std::cerr << "hsdm: " << a.input << ": " << built.rejected
                  << " facets were left out, which no 2-manifold can hold\n";
    for (const auto& [plugin, request] : steps) {
        if (interrupted()) throw Cancelled();
        const std::string summary = plugin.process(built.mesh, request.options);
        if (!a.quiet) text << plugin.name() << ": " << summary << '\n';
    }
    WriteOptions options;
    options.ascii = a.ascii;
    write_mesh(a.output, to_polygons(built.mesh), format, options);
    return done;
}

} // namespace

void add_process(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("process", "a mesh through processing modules loaded at run time");
    const auto a = std::make_shared<ProcessArguments>();
    sub->add_option("mesh", a->input, "OFF, STL, PLY or OBJ");
    sub->add_option("-o,--output", a->output, "the mesh to write; - is standard output")->type_name("FILE");
    sub->add_option("--format", a->format, "its format, where no extension names it")
        ->check(CLI::IsMember({"off", "stl", "ply", "obj", "om"}))
        ->type_name("off|stl|ply|obj|om");
    sub->add_flag("--ascii", a->ascii, "text instead of binary STL and PLY");
    sub->add_option("--module", a->modules,
                    "NAME or NAME:key=value,key=value; several run in the order given")
        ->type_name("MODULE");
    sub->add_flag("--list", a->list, "the modules there are, and their options");
    sub->add_flag("--quiet", a->quiet, "no summary, errors only");
    sub->footer(
        "Modules are looked for in the folders of HSDM_PLUGIN_PATH, then in lib/hsdm/plugins beside the\n"
        "command's folder.\nExamples:\n  hsdm process --list\n"
        "  hsdm process part.off --module classify-features --module smooth-normals -o part.ply");
    sub->callback([&run, a] { run = [a] { return run_process(*a); }; });
}

} // namespace hsdm::command
