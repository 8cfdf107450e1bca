// hsdm compare: how far two surfaces, or a surface and a cloud, are apart.

#include "command.hh"
#include "file_claims.hh"
#include "load.hh"
#include "messages.hh"
#include "summary.hh"

#include "hsdm/errors.hh"
#include "hsdm/quality/compare.hh"

#include <iostream>

namespace hsdm::command {
namespace {

void fill(JsonText& json, const Distance& distance, double diagonal) {
    json.begin_object();
    json.member("max", distance.max);
    json.member("mean", distance.mean);
    json.member("rms", distance.rms);
    json.member("normalised_max", diagonal > 0 ? distance.max / diagonal : 0);
    json.end();
}

void fill(JsonText& json, const std::string& path, const Loaded& loaded) {
    json.begin_object();
    json.member("file", path);
    json.member("kind", loaded.is_mesh() ? "mesh" : "cloud");
    if (loaded.is_mesh()) {
        json.key("mesh");
        fill_topology(json, loaded.mesh);
    } else {
        json.member("points", loaded.cloud.size());
        json.member("dropped_nonfinite", loaded.dropped.nonfinite);
    }
    json.end();
}

void print(const char* title, const Distance& distance, double diagonal) {
    std::cout << title << "  max " << distance.max << " ("
              << (diagonal > 0 ? 100 * (distance.max / diagonal) : 0) << " % of the diagonal), mean "
              << distance.mean << ", rms " << distance.rms << '\n';
}

void print(const char* title, const std::string& path, const Loaded& loaded) {
    std::cout << title << "         " << printable(path) << '\n';
    if (loaded.is_mesh()) {
        print_topology(std::cout, loaded.mesh);
    } else {
        std::cout << "cloud     " << grouped(loaded.cloud.size()) << " points\n";
        print_dropped(std::cout, loaded.dropped);
    }
}

int run_compare(const std::string& path_a, const std::string& path_b, bool as_json) {
    if (path_a == "-" && path_b == "-")
        throw UsageError("standard input holds one of the two; name the other");
    FileClaims claims;
    for (const std::string* path : {&path_a, &path_b}) claims.reads("the file", *path);
    claims.writes("the output", "-");
    claims.check();
    const Loaded a = load(path_a), b = load(path_b);
    if (!a.is_mesh() && !b.is_mesh())
        throw Error(path_b, "both files hold points without faces; one of the two must be a mesh");
    const Comparison result = compare(a.mesh, b.mesh);
    if (as_json) {
        JsonText json;
        json.begin_object();
        json.key("a");
        fill(json, path_a, a);
        json.key("b");
        fill(json, path_b, b);
        json.key("a_to_b");
        fill(json, result.a_to_b, result.diagonal);
        json.key("b_to_a");
        fill(json, result.b_to_a, result.diagonal);
        json.member("hausdorff", result.hausdorff());
        json.member("diagonal", result.diagonal);
        json.end();
        std::cout << std::move(json).take();
        return done;
    }
    print("a", path_a, a);
    print("b", path_b, b);
    print("a to b", result.a_to_b, result.diagonal);
    print("b to a", result.b_to_a, result.diagonal);
    return done;
}

} // namespace

void add_compare(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("compare", "distances between a mesh and a cloud or another mesh");
    struct Arguments {
        std::string a, b;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    sub->add_option("a", arguments->a, "a mesh or a cloud; - is standard input")->required();
    sub->add_option("b", arguments->b, "a mesh or a cloud; one of the two is a mesh")->required();
    sub->add_flag("--json", arguments->json, "as JSON");
    sub->footer(
        "Distances of a cloud are taken from every point, those of a mesh from points spread over its area\n"
        "and from its vertices.\nExamples:\n  hsdm compare part.off scan.ply\n"
        "  hsdm compare part.off truth.off --json");
    sub->callback([&run, arguments] {
        run = [arguments] { return run_compare(arguments->a, arguments->b, arguments->json); };
    });
}

} // namespace hsdm::command
