#include "mesh_stages.hh"

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "module_watch.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/pipeline/measure.hh"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

namespace hsdm::command {
namespace {

Box box_of(const PolyMesh& mesh) {
    Box box;
    for (const auto v : mesh.vertices()) box.add(mesh.point(v));
    return box;
}

void scale(PolyMesh& mesh, double factor) {
    if (factor == 1) return;
    for (const auto v : mesh.vertices()) mesh.set_point(v, mesh.point(v) * factor);
}

} // namespace

std::vector<StageCall> parse_stages(const std::vector<std::string>& texts, const std::string& folder) {
    std::vector<StageCall> stages;
    for (const std::string& text : texts) stages.push_back(parse_stage_call(text, plugin_folders(), folder));
    return stages;
}

void claim_stage_files(const std::vector<StageCall>& stages, FileClaims& claims) {
    for (const StageCall& call : stages) {
        if (!call.stage.module.empty()) claims.reads("the module", call.stage.module);
        for (const std::string& file : call.files())
            claims.reads("the " + call.stage.name + " stage's", file);
    }
}

bool take_scan(const std::vector<StageCall>& stages) {
    return std::ranges::any_of(stages, [](const StageCall& call) { return call.takes_scan(); });
}

double unit_for_stages(const Box& box) {
    return CloudFrame(box).unit();
}

std::string words_of_unit(const std::string& input, double unit) {
    return input + ": lengths, also those of the stages' options, are measured in units of 2^"
           + std::to_string(std::ilogb(unit));
}

Report::Stage run_stage(const std::string& input, const StageCall& call, PolyMesh& mesh,
                        const StageContext& context) {
    static std::mutex one_at_a_time; // there is one ModuleWatch, and a module need not know of threads
    const std::lock_guard held(one_at_a_time);
    const auto start = std::chrono::steady_clock::now();
    Report::Stage done{call.text, "", 0};
    set_phase(call.text.c_str());
    try {
        const ModuleWatch watch(input + (call.stage.module.empty() ? ": stage " : ": module ")
                                + call.stage.name);
        done.summary = call(mesh, context);
    } catch (const Error& error) {
        throw Error(input, error.what());
    }
    done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return done;
}

PointCloud scan_for_stages(const std::vector<StageCall>& stages, const PointCloud& cloud, bool measured) {
    if (take_scan(stages)) return cloud;
    PointCloud kept;
    if (measured && !stages.empty()) kept.positions = cloud.positions;
    return kept;
}

void run_stages(const std::string& input, const std::vector<StageCall>& stages, const PointCloud& scan,
                bool measured, bool quiet, Reconstruction& result) {
    if (stages.empty()) return;
    const double unit = unit_for_stages(box_of(result.mesh));
    if (unit != 1 && !quiet) complain(words_of_unit(input, unit));
    scale(result.mesh, 1 / unit);
    for (const StageCall& call : stages)
        result.report.stages.push_back(run_stage(input, call, result.mesh, {&scan, unit}));
    result.mesh.delete_isolated_vertices();
    result.mesh.garbage_collection();
    scale(result.mesh, unit);
    measure_again(result.mesh, measured ? std::span<const Vec3>(scan.positions) : std::span<const Vec3>(),
                  result.report);
}

} // namespace hsdm::command
