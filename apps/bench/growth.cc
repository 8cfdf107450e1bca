// hsdm_bench growth: seconds of a reconstruction from file to file, over clouds of growing size.

#include "benchmarks.hh"
#include "phase_steps.hh"
#include "plot.hh"
#include "timed_scan.hh"
#include "yard.hh"

#include "hsdm/io/read_points.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/folder.hh"
#include "support/named_solid.hh"

#include <CLI/CLI.hpp>

#include <cstdio>

using namespace hsdm;

namespace {

/// A run from file to file: its report with the seconds of all of it.
Report run_once(const bench::Work& work, const ReconstructOptions& options) {
    const double start = bench::now();
    PointFile file = read_points(work.points_file);
    const double read = bench::now();
    Reconstruction part = reconstruct(std::move(file.cloud), options);
    const double made = bench::now();
    write_mesh(work.mesh_file, to_polygons(part.mesh), MeshFormat::ply);
    Report report = std::move(part.report);
    report.seconds.read = read - start;
    report.seconds.write = bench::now() - made;
    report.seconds.total = bench::now() - start;
    return report;
}

Report best_run(const bench::Work& work, const ReconstructOptions& options, int repeats) {
    Report best = run_once(work, options);
    for (int i = 1; i < repeats; ++i) {
        Report report = run_once(work, options);
        if (report.seconds.total < best.seconds.total) best = std::move(report);
    }
    return best;
}

struct Column {
    const char* name;
    double Report::Seconds::*seconds;
};

constexpr Column columns[] = {
    {"all", &Report::Seconds::total},         {"read", &Report::Seconds::read},
    {"octree", &Report::Seconds::octree},     {"normals", &Report::Seconds::normals},
    {"sets", &Report::Seconds::graph},        {"facets", &Report::Seconds::facets},
    {"error", &Report::Seconds::error},       {"mesh", &Report::Seconds::mesh},
    {"features", &Report::Seconds::features}, {"write", &Report::Seconds::write},
};

void print_sizes_head() {
    std::printf("| points | voxels | Y |");
    for (const Column& column : columns) std::printf(" %s |", column.name);
    std::printf(" all / Y | ns per point | MB |\n|---|---|---|---|---|---|");
    for (std::size_t i = 0; i < std::size(columns); ++i) std::printf("---|");
    std::printf("\n");
}

void print_size(std::size_t points, double y, const Report& r) {
    std::printf("| %zu | %zu | %.3f |", points, r.grid.voxels, y);
    for (const Column& column : columns) std::printf(" %.3f |", r.seconds.*column.seconds);
    std::printf(" %.2f | %.0f | %zu |\n", r.seconds.total / y,
                1e9 * r.seconds.total / static_cast<double>(points), r.peak_memory_bytes / 1000000);
    std::fflush(stdout);
}

void draw_growth(const std::vector<std::size_t>& sizes, const std::vector<Report>& reports,
                 const std::string& path) {
    const auto least = static_cast<double>(sizes.front()), most = static_cast<double>(sizes.back());
    bench::Plot plot({"points", least, std::max(most, 1.001 * least), bench::round_ticks(least, most)},
                     {"ns per point", 1, 5000, {1, 10, 100, 1000}});
    for (const Column& column : columns) {
        std::vector<bench::PlotPoint> line; // of phases below 1 ns at the foot
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            const auto n = static_cast<double>(sizes[i]);
            line.push_back({n, 1e9 * (reports[i].seconds.*column.seconds) / n});
        }
        plot.line(line, column.name);
    }
    plot.write(path);
}

} // namespace

int bench::growth(int argc, char** argv) {
    CLI::App app(
        "Seconds of a reconstruction from file to file by phase, over clouds of growing size; the points "
        "of a voxel stay as many.");
    TimedScan scan{.repeats = 3};
    scan.add_options(app);
    std::string plot_file, normals = "given";
    std::vector<std::size_t> sizes{100000, 300000, 1000000, 3000000, 10000000};
    double max_error = 0;
    bool basic = false;
    ReconstructOptions options;
    app.add_option("--sizes", sizes, "numbers of points")
        ->delimiter(',')
        ->check(CLI::Range(1000, 2000000000))
        ->capture_default_str();
    app.add_option("--normals", normals, "given or estimate")
        ->check(CLI::IsMember({"given", "estimate"}))
        ->capture_default_str();
    app.add_flag("--basic", basic, "the basic method");
    app.add_option("--max-error", max_error,
                   "share of the diagonal, for adaptive grids, whose voxels follow "
                   "from it; 0: none");
    app.add_option("--threads", options.threads, "at most so many; 0: all")->check(CLI::NonNegativeNumber);
    app.add_option("--plot", plot_file, "an SVG file: nanoseconds of a point by phase, over the points");
    CLI11_PARSE(app, argc, argv);
    if (normals == "estimate") options.normals = NormalSource::estimate;
    if (basic) options.method = Method::basic;

    std::vector<Report> reports;
    const support::Folder folder;
    print_sizes_head();
    for (const std::size_t points : sizes) {
        const Work work = make_work(scan.shape, points, scan.points_per_voxel, folder.path());
        if (max_error > 0)
            options.max_error = MaxError{max_error, true};
        else
            options.voxel_size = work.cube_extent / static_cast<double>(1u << work.depth);
        const double y = sort_seconds(1);
        reports.push_back(best_run(work, options, scan.repeats));
        print_size(points, y, reports.back());
    }
    if (!plot_file.empty()) draw_growth(sizes, reports, plot_file);
    return 0;
}
