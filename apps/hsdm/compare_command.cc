// hsdm compare: how far two meshes, two clouds, or a mesh and a cloud are apart.

#include "command.hh"
#include "comparison_json.hh"
#include "file_claims.hh"
#include "load.hh"
#include "messages.hh"
#include "summary.hh"

#include "hsdm/quality/compare.hh"

#include <iostream>

namespace hsdm::command {
namespace {

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

void print(const char* title, const Distance& distance, const Percentiles& percentiles, double diagonal) {
    std::cout << title << "  max " << distance.max << " ("
              << (diagonal > 0 ? 100 * (distance.max / diagonal) : 0) << " % of the diagonal), mean "
              << distance.mean << ", rms " << distance.rms << "; median " << percentiles.median
              << ", 95 % within " << percentiles.p95 << ", 99 % within " << percentiles.p99 << '\n';
}

void print(const char* title, const std::string& path, const Loaded& loaded) {
    std::cout << title << "         " << printable(path) << '\n';
    if (loaded.is_mesh()) {
        print_topology(std::cout, loaded.mesh);
    } else {
        std::cout << "cloud     " << grouped(loaded.cloud.size()) << " points\n";
        print_dropped(std::cout, loaded);
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
    const Comparison result = compare(a.mesh, b.mesh);
    if (as_json) {
        JsonText json;
        json.begin_object();
        json.key("a");
        fill(json, path_a, a);
        json.key("b");
        fill(json, path_b, b);
        fill_comparison(json, result, "a_to_b", "b_to_a");
        json.end();
        std::cout << std::move(json).take();
        return done;
    }
    print("a", path_a, a);
    print("b", path_b, b);
    print("a to b", result.a_to_b, result.a_to_b_percentiles, result.diagonal);
    print("b to a", result.b_to_a, result.b_to_a_percentiles, result.diagonal);
    return done;
}

} // namespace

void add_compare(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("compare", "distances between two meshes, two clouds, or a mesh and a cloud");
    struct Arguments {
        std::string a, b;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    sub->add_option("a", arguments->a, "a mesh or a cloud; - is standard input")->required();
    sub->add_option("b", arguments->b, "a mesh or a cloud")->required();
    sub->add_flag("--json", arguments->json, "as JSON")->group("Output");
    sub->footer(
        "Distances of a cloud are taken from every point, those of a mesh from points spread over its area\n"
        "and from its vertices. To a mesh they are those to its surface, to a cloud those to its nearest "
        "point.\n"
        "Examples:\n  hsdm compare part.off scan.ply\n  hsdm compare part.off truth.off --json\n"
        "  hsdm compare scan.ply later.ply");
    sub->callback([&run, arguments] {
        run = [arguments] { return run_compare(arguments->a, arguments->b, arguments->json); };
    });
}

} // namespace hsdm::command
