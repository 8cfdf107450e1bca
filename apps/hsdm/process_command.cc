// hsdm process: a mesh through stages.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "mesh_stages.hh"
#include "messages.hh"
#include "reconstruct_output.hh"
#include "stages_command.hh"
#include "summary.hh"
#include "usage.hh"

#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/point_cloud.hh"

#include <filesystem>
#include <iostream>

namespace hsdm::command {
namespace {

struct ProcessArguments {
    std::string input, output, format;
    std::vector<std::string> stages;
    bool list = false, ascii = false, quiet = false, in_place = false;
};

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

/// Throws UsageError for an output that would destroy the mesh, unless that is what was asked for, a module
/// or what a stage reads.
void check_claims(const ProcessArguments& a, const std::vector<StageCall>& stages) {
    FileClaims claims = mesh_claims(a);
    try {
        claims.check();
    } catch (const UsageError& error) {
        if (a.input == "-") throw;
        throw UsageError(std::string(error.what()) + ", or overwrite the mesh with --in-place");
    }
    claim_stage_files(stages, claims);
    if (!a.quiet && !is_standard_output(a.in_place ? a.input : a.output)) claims.writes("the summary", "-");
    claims.check();
}

/// A mesh that is read has no scan with it.
void check_scans(const std::vector<StageCall>& stages) {
    for (const StageCall& call : stages)
        if (call.takes_scan())
            throw OptionError(call.stage.name + ": " + call.stage.instead_of_scan
                              + ": not given, and a mesh that is read has no scan with it; name a file");
}

PolygonMesh read_input(const std::string& input) {
    set_activity(input.c_str(), "read");
    PolygonMesh facets = read_mesh(input);
    if (facets.facet_count() == 0)
        throw Error(input, "holds no faces; reconstruct a mesh from its points first");
    return facets;
}

/// Returns the unit that the mesh is measured in then.
double scale_for_stages(PolygonMesh& facets, const ProcessArguments& a) {
    const double unit = unit_for_stages(bounds_of(facets.positions));
    if (unit == 1) return unit;
    for (Vec3& p : facets.positions) p /= unit;
    if (!a.quiet) complain(words_of_unit(a.input, unit));
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

int run_process(const ProcessArguments& a) {
    if (a.list) return list_stages(false);
    if (a.in_place && a.input == "-")
        throw UsageError("--in-place writes the mesh's own file, and standard input has none; use -o FILE");
    std::error_code ignored;
    if (a.in_place && !a.output.empty() && !std::filesystem::equivalent(a.input, a.output, ignored))
        throw UsageError("--in-place writes the mesh's own file, and -o names another; leave one out");
    if (a.input.empty() || (a.output.empty() && !a.in_place) || a.stages.empty())
        throw UsageError("process needs a mesh, -o FILE or --in-place, and at least one --stage NAME");
    const std::string& output = a.in_place ? a.input : a.output;
    const MeshFormat format = format_for(output, a.format);
    const std::vector<StageCall> stages = parse_stages(a.stages);
    check_scans(stages);
    check_claims(a, stages);
    check_writable(output);
    PolygonMesh facets = read_input(a.input);
    const double unit = scale_for_stages(facets, a);
    ToMeshResult built = build(a.input, facets);
    facets = {};
    std::ostream& text = is_standard_output(output) ? std::cerr : std::cout;
    for (const StageCall& stage : stages) {
        const std::string summary = run_stage(a.input, stage, built.mesh, {nullptr, unit}).summary;
        if (!a.quiet) text << printable(stage.stage.name + ": " + summary) << std::endl;
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
    if (!a.quiet) text << written_words(report_of(target, written));
    return done;
}

} // namespace

void add_process(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("process", "a mesh through stages, built in or loaded at run time");
    const auto a = std::make_shared<ProcessArguments>();
    sub->option_defaults()->group("Files");
    sub->add_option("mesh", a->input, "OFF, STL, PLY, OBJ or .om");
    sub->add_option("-o,--output", a->output, "the mesh to write; - is standard output")->type_name("FILE");
    sub->add_flag("--in-place", a->in_place, "write the mesh's own file instead");
    sub->add_option("--format", a->format, "its format, where no extension names it (default: off)")
        ->check(one_of(mesh_format_names()))
        ->type_name(joined(mesh_format_names(), "|"));
    sub->add_flag("--ascii", a->ascii, "text instead of binary STL and PLY");
    sub->option_defaults()->group("Stages");
    sub->add_option(
           "--stage,--module", a->stages,
           "NAME or NAME:key=value,key=value; several run in the order given, hsdm stages names them; "
           "at least one is needed (default: none)")
        ->type_name("STAGE");
    sub->add_flag("--list", a->list, "the stages there are, as hsdm stages");
    sub->option_defaults()->group("Running");
    sub->add_flag("--quiet", a->quiet, "no summary, errors only");
    sub->footer(
        "Modules are looked for in the folders of HSDM_PLUGIN_PATH, then in that of the installation, and\n"
        "refused if others could have written them.\nExamples:\n  hsdm process --list\n"
        "  hsdm process part.off --stage classify --stage decimate:ratio=0.125 -o part.ply");
    sub->callback([&run, a] { run = [a] { return run_process(*a); }; });
}

} // namespace hsdm::command
