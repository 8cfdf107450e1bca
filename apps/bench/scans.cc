// What becomes of scans from a few places, with growing faults, when what nobody saw is completed; prints the
// table of docs/completion.md.

#include "benchmarks.hh"
#include "plot.hh"

#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/scanner.hh"
#include "support/scenes.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

using namespace hsdm;
using namespace hsdm::support;

namespace {

struct Part {
    const char* name;
    Solid solid;
    double radius; // of a ball about the origin that holds it
    long euler;
};

std::vector<Part> parts() {
    const auto up = [](double z) { return turned({0, 0, 1}, 0.3, {0.02, 0.01, z}); };
    return {
        {"ball", sphere(1), 1.05, 2},
        {"ring", torus(1, 0.35).placed(turned({1, 0.2, 0}, 0.9)), 1.4, 0},
        {"block", box({1.4, 1, 0.8}).placed(turned({0, 0, 1}, 0.4)), 1, 2},
        {"cup", (cylinder(0.8, 1.4) - cylinder(0.6, 1.4).placed(up(0.2))), 1.1, 2},
        {"bracket",
         box({1.4, 1, 1}).placed(turned({0, 0, 1}, 0.7))
             - box({1.1, 1.4, 1}).placed(turned({0, 0, 1}, 0.7, {0.2, 0.17, 0.3})),
         1.05, 2},
        {"part with shafts", mechanical_part(turned({0.1, 1, 0}, 1.45)), 1.7, -4},
    };
}

/// Scenes are other ones by each seed; parts the same.
std::vector<Part> objects(bool scenes, std::uint64_t seed) {
    if (!scenes) return parts();
    std::vector<Part> result;
    for (std::uint64_t k = 0; k < 5; ++k) {
        const Scene made = scene(5 * seed + k);
        result.push_back({made.name, made.solid, made.radius, made.euler});
    }
    return result;
}

struct ScanFault {
    const char* name;
    std::vector<double> strengths;
    void (*apply)(double strength, ScannerOptions& options);
};

/// Lengths are in hundredths of the part's radius.
const std::vector<ScanFault> scan_faults = {
    {"noise", {0, 0.5, 1, 2, 3}, [](double s, ScannerOptions& o) { o.noise = s; }},
    {"misalignment", {0.25, 0.5, 1, 2}, [](double s, ScannerOptions& o) { o.misalignment = s; }},
    {"outliers, %", {1, 3, 10}, [](double s, ScannerOptions& o) { o.outliers = s; }},
    {"holes' radius", {10, 20, 40}, [](double s, ScannerOptions& o) { o.holes = s; }},
    {"positions", {8, 3, 2}, [](double s, ScannerOptions& o) { o.positions = static_cast<int>(s); }},
};

struct Outcome {
    bool made = false;
    bool right = false, intersects = false;
    double off = 0; // mean distance of vertices from the part, in hundredths of its radius
    std::string what;
};

Outcome outcome(const Part& part, const ScannerOptions& scanner, bool sensors) {
    ReconstructOptions options;
    options.holes = Holes::complete;
    Outcome result;
    try {
        PointCloud cloud = scan_from_above(part.solid, part.radius, scanner);
        if (!sensors) cloud.sensors.clear(), cloud.sensor_of.clear();
        const Reconstruction made = reconstruct(std::move(cloud), options);
        const Report::Mesh& m = made.report.mesh;
        const PolygonMesh mesh = to_polygons(made.mesh);
        result.made = true;
        result.intersects = !find_self_intersections(mesh).facet_pairs.empty();
        result.right = m.closed && m.components == 1 && m.euler == part.euler && !result.intersects;
        for (const Vec3& p : mesh.positions)
            result.off += 100 * std::abs(part.solid.distance(p)) / part.radius
                          / static_cast<double>(mesh.vertex_count());
        result.what = !m.closed          ? "open"
                      : m.components > 1 ? std::to_string(m.components) + " parts"
                                         : "euler " + std::to_string(m.euler);
    } catch (const Error& error) {
        result.what = error.what();
    }
    return result;
}

/// Which scans are made.
struct ScanRows {
    std::size_t points = 60000; // rays of a scan
    std::uint64_t first_seed = 1, seeds = 2;
    bool sensors = false, scenes = false, verbose = false;
    std::string only_part;
};

/// What became of all scans with one fault of one strength.
struct FaultRow {
    double strength = 0;
    int right = 0, all = 0, made = 0, intersecting = 0;
    double off = 0; // summed

    double mean_off() const { return off / std::max(made, 1); }
    double share_right() const { return 100.0 * right / std::max(all, 1); }
};

ScannerOptions scanner_of(const ScanFault& fault, double strength, double radius, std::uint64_t seed,
                          std::size_t points) {
    ScannerOptions scanner;
    scanner.points = points;
    scanner.seed = seed;
    fault.apply(strength, scanner);
    scanner.noise *= radius / 100, scanner.misalignment *= radius / 100;
    scanner.holes *= radius / 100, scanner.outliers /= 100;
    return scanner;
}

FaultRow row_of(const ScanFault& fault, double strength, const ScanRows& how) {
    FaultRow row{.strength = strength};
    for (std::uint64_t seed = how.first_seed; seed < how.first_seed + how.seeds; ++seed)
        for (const Part& part : objects(how.scenes, seed)) {
            if (std::string_view(part.name).find(how.only_part) == std::string_view::npos) continue;
            const Outcome made =
                outcome(part, scanner_of(fault, strength, part.radius, seed, how.points), how.sensors);
            ++row.all, row.made += made.made, row.right += made.right, row.intersecting += made.intersects,
                row.off += made.off;
            if (how.verbose && !made.right)
                std::fprintf(stderr, "%s %g, %s, seed %d: %s%s, %.2f off\n", fault.name, strength, part.name,
                             static_cast<int>(seed), made.what.c_str(), made.intersects ? ", intersects" : "",
                             made.off);
        }
    return row;
}

std::vector<FaultRow> print_fault(const ScanFault& fault, const ScanRows& how) {
    std::vector<FaultRow> rows;
    for (const double strength : fault.strengths) {
        const FaultRow& row = rows.emplace_back(row_of(fault, strength, how));
        std::printf("| %s | %g | %d of %d | %d | %.2f |\n", fault.name, strength, row.right, row.all,
                    row.intersecting, row.mean_off());
        std::fflush(stdout);
    }
    return rows;
}

/// Of each fault, how what `value` says of a row goes with the strength; none of strength 0.
void draw_faults(const std::vector<std::pair<const char*, std::vector<FaultRow>>>& by_fault,
                 const bench::Axis& y, double (FaultRow::*value)() const, const std::string& path) {
    bench::Plot plot({"strength", 0.2, 50, bench::round_ticks(0.2, 50)}, y);
    for (const auto& [name, rows] : by_fault) {
        std::vector<bench::PlotPoint> line;
        for (const FaultRow& row : rows)
            if (row.strength > 0 && row.made > 0) line.push_back({row.strength, (row.*value)()});
        plot.line(line, name);
    }
    plot.write(path);
}

} // namespace

int bench::scans(int argc, char** argv) {
    CLI::App app(
        "Scans from a few places with growing faults, completed: how many come out right, and how near.");
    ScanRows how;
    std::string only, plot_of_distance, plot_of_right;
    app.add_option("--points", how.points, "rays of a scan");
    app.add_option("--seeds", how.seeds, "scans of each part");
    app.add_option("--first-seed", how.first_seed, "seed of the first scan");
    app.add_option("--part", how.only_part, "the objects whose names hold this");
    app.add_option("--fault", only, "the faults whose names hold this");
    app.add_flag("--sensors", how.sensors, "with the scanner's positions");
    app.add_flag("--scenes", how.scenes, "of things on a floor in place of parts");
    app.add_flag("--verbose", how.verbose, "says what fails");
    app.add_option("--plot", plot_of_distance, "an SVG file: mean distance over strength, by fault");
    app.add_option("--plot-right", plot_of_right, "an SVG file: the percentage that is right, likewise");
    CLI11_PARSE(app, argc, argv);
    const auto is_asked_for = [&](const ScanFault& fault) {
        return std::string_view(fault.name).find(only) != std::string_view::npos;
    };
    if (std::ranges::none_of(scan_faults, is_asked_for)) {
        std::fprintf(stderr, "scans: no fault is named like '%s'\n", only.c_str());
        return 2;
    }
    std::printf("| fault | strength | right | intersecting | mean distance |\n|---|---|---|---|---|\n");
    std::vector<std::pair<const char*, std::vector<FaultRow>>> by_fault;
    for (const ScanFault& fault : scan_faults)
        if (is_asked_for(fault)) by_fault.emplace_back(fault.name, print_fault(fault, how));
    if (!plot_of_distance.empty())
        draw_faults(by_fault, {"mean distance, % of the radius", 0.2, 10, round_ticks(0.2, 10)},
                    &FaultRow::mean_off, plot_of_distance);
    if (!plot_of_right.empty())
        draw_faults(by_fault, {"right, %", 0, 100, {0, 25, 50, 75, 100}, false}, &FaultRow::share_right,
                    plot_of_right);
    return 0;
}
