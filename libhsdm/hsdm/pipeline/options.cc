#include "hsdm/pipeline/options.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/errors.hh"
#include "hsdm/octree/octree.hh"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace hsdm {
namespace {

void check_depth(const std::string& name, int depth) {
    check_option(depth >= 1 && depth <= deepest_level, name, depth,
                 "lie in [1, " + std::to_string(deepest_level) + "]");
}

std::string name_of(Holes holes) {
    return holes == Holes::keep       ? "keep"
           : holes == Holes::close    ? "close"
           : holes == Holes::complete ? "complete"
                                      : "auto";
}

} // namespace

std::string text_of(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.10g", value);
    return digits;
}

Method method_for(const ReconstructOptions& options) {
    return options.method == Method::basic ? Method::basic : Method::extended;
}

bool must_estimate(const PointView& cloud, const ReconstructOptions& options) {
    if (method_for(options) == Method::basic) return false;
    return options.normals == NormalSource::estimate || !cloud.has_normals();
}

bool are_voxels_asked_for(const ReconstructOptions& options, const Report& report) {
    return options.depth || options.voxel_size || report.options.contains("levels");
}

bool wants_adaptive(const ReconstructOptions& options) {
    return options.grid == Grid::adaptive || (options.grid == Grid::automatic && options.max_error);
}

bool wants_confidence(const ReconstructOptions& options) {
    return options.confidence || options.trim > 0;
}

void note_left_out(const std::vector<std::string>& names, Report& report) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    if (!all.empty()) report.options["left_out"] = all;
}

void note_options(bool estimate, const ReconstructOptions& options, Report& report) {
    const bool extended = method_for(options) == Method::extended;
    report.options["method"] = extended ? "extended" : "basic";
    report.options["normals"] = estimate ? "estimate" : extended ? "given" : "none";
    report.options["grid"] = wants_adaptive(options) ? "adaptive" : "uniform";
    if (options.max_error)
        report.options["max-error"] = options.max_error->of_diagonal
                                          ? text_of(100 * options.max_error->value) + "%"
                                          : text_of(options.max_error->value);
    report.options["holes"] = name_of(options.holes);
    if (options.trim > 0) report.options["trim"] = text_of(options.trim);
    if (options.merge_layers) report.options["merge-layers"] = "yes";
    if (options.min_component)
        report.options["min-component"] = options.min_component->of_largest
                                              ? text_of(100 * options.min_component->value) + "%"
                                              : text_of(options.min_component->value);
    report.options["crease-degrees"] = text_of(options.crease_angle * 180 / std::numbers::pi);
    report.options["smoothing"] = std::to_string(options.normal_smoothing);
}

void check_options(const ReconstructOptions& o) {
    if (!!o.depth + !!o.voxel_size + !!o.max_error > 1)
        throw OptionError("depth, voxel_size and max_error: at most one of the three says the resolution");
    if (o.max_error && !(o.max_error->value > 0 && std::isfinite(o.max_error->value)))
        throw OptionError("max_error " + text_of(o.max_error->value) + ": must be above 0");
    if (o.max_error && o.grid == Grid::uniform)
        throw OptionError("max_error: a uniform grid has no bound to keep; use the adaptive one");
    if (o.depth) check_depth("depth", *o.depth);
    if (o.voxel_size && !(*o.voxel_size > 0 && std::isfinite(*o.voxel_size)))
        throw OptionError("voxel_size " + text_of(*o.voxel_size) + ": must be a length above 0");
    if (o.min_component
        && !(o.min_component->value >= 0 && std::isfinite(o.min_component->value)
             && !(o.min_component->of_largest && o.min_component->value > 1)))
        throw OptionError("min_component " + text_of(o.min_component->value)
                          + ": must be a number of facets, or a share of the largest of 1 (100 %) at most");
    check_option(o.trim >= 0 && o.trim <= 1, "trim", o.trim, "lie between 0 and 1");
    if (wants_confidence(o) && o.method == Method::basic)
        throw OptionError("confidence and trim: the basic method tells none; use the extended one");
    if (!(o.crease_angle > 0 && o.crease_angle < std::numbers::pi))
        throw OptionError("crease_angle " + text_of(o.crease_angle)
                          + " rad: must lie between 0 and pi (180 degrees)");
    check_option(o.normal_smoothing >= 0, "normal_smoothing", o.normal_smoothing, "be 0 or more");
    check_option(o.threads >= 0, "threads", o.threads, "be 0 (all) or more");
    if (o.normals == NormalSource::estimate && o.method == Method::basic)
        throw OptionError("normals estimate: the basic method uses no normals; use the extended one");
}

void check_options(const ReconstructOptions& options, int first_depth, int last_depth) {
    check_options(options);
    if (options.depth || options.voxel_size || options.max_error)
        throw OptionError(
            "levels: they are the resolution; depth, voxel_size and max_error cannot be given beside them");
    check_depth("first depth", first_depth);
    check_depth("last depth", last_depth);
    if (first_depth > last_depth)
        throw OptionError("levels " + std::to_string(first_depth) + ":" + std::to_string(last_depth)
                          + ": the first depth must not be above the last");
}

} // namespace hsdm
