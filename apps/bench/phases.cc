// hsdm_bench phases: where the nanoseconds of a reconstruction go, phase by phase, and how far each is from
// what copying its arrays would take.

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
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>

using namespace hsdm;

namespace {

/// What is known of a phase.
struct Row {
    std::string name, function;
    double seconds, bytes;
    bench::Role role = bench::Role::phase;
};

struct Size {
    double points, voxels;
};

/// The fastest of so many runs of each.
std::vector<Row> time_steps(bench::Work& work, int repeats) {
    std::vector<Row> rows;
    for (const bench::Step& step : bench::phase_steps()) {
        double best = bench::seconds_of(step, work);
        for (int i = 1; i < repeats; ++i) best = std::min(best, bench::seconds_of(step, work));
        rows.push_back({step.name, step.function, best, step.bytes(work), step.role});
    }
    return rows;
}

/// A whole becomes what its parts, beside it, leave of it.
void take_parts_off(std::vector<Row>& rows) {
    double parts = 0;
    for (const Row& row : rows)
        if (row.role == bench::Role::part) parts += row.seconds;
    for (Row& row : rows) {
        if (row.role != bench::Role::whole) continue;
        row.name = "facets", row.function = "the rest of " + row.function;
        row.seconds = std::max(0.0, row.seconds - parts);
    }
}

/// The rest of a whole has no bytes of its own.
void print_phase(const Row& row, const Size& size, double total, double bandwidth) {
    if (row.role == bench::Role::whole) {
        std::printf("| %s | `%s` | %.1f | %.1f | %.0f | %.0f | | | |\n", row.name.c_str(),
                    row.function.c_str(), 1e3 * row.seconds, 100 * row.seconds / total,
                    1e9 * row.seconds / size.points, 1e9 * row.seconds / size.voxels);
        return;
    }
    const double rate = row.bytes / row.seconds;
    std::printf("| %s | `%s` | %.1f | %.1f | %.0f | %.0f | %.0f | %.2f | %.1f |\n", row.name.c_str(),
                row.function.c_str(), 1e3 * row.seconds, 100 * row.seconds / total,
                1e9 * row.seconds / size.points, 1e9 * row.seconds / size.voxels, row.bytes / size.points,
                rate / 1e9, 100 * rate / bandwidth);
}

void print_phases(const std::vector<Row>& rows, const Size& size, double bandwidth) {
    Row all{"all", "", 0, 0};
    for (const Row& row : rows) {
        all.seconds += row.seconds;
        all.bytes += row.role == bench::Role::whole ? 0 : row.bytes;
    }
    std::printf(
        "| phase | function | ms | %% of all | ns per point | ns per voxel | bytes per point | GB/s | "
        "%% of copying |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const Row& row : rows) print_phase(row, size, all.seconds, bandwidth);
    std::printf("| all | | %.1f | 100 | %.0f | %.0f | %.0f | %.2f | %.1f |\n", 1e3 * all.seconds,
                1e9 * all.seconds / size.points, 1e9 * all.seconds / size.voxels, all.bytes / size.points,
                all.bytes / all.seconds / 1e9, 100 * all.bytes / all.seconds / bandwidth);
}

/// Nanoseconds over bytes, both of a point, and what copying the bytes would take.
void draw_phases(const std::vector<Row>& rows, const Size& size, double bandwidth, const std::string& path) {
    const bench::Axis bytes{"bytes read and made, per point", 5, 2000, {10, 20, 50, 100, 200, 500, 1000}};
    const bench::Axis time{"ns per point", 0.5, 1000, {1, 2, 5, 10, 20, 50, 100, 200, 500}};
    bench::Plot plot(bytes, time);
    for (const double share : {1.0, 0.1, 0.01}) {
        const double slope = 1e9 / (share * bandwidth); // ns per byte
        const double from = std::max(bytes.least, time.least / slope);
        const double to = std::min(bytes.most, time.most / slope);
        char name[32];
        std::snprintf(name, sizeof name, "%g %% of copying", 100 * share);
        plot.guide({from, from * slope}, {to, to * slope}, name);
    }
    for (const Row& row : rows)
        if (row.role != bench::Role::whole)
            plot.mark({row.bytes / size.points, 1e9 * row.seconds / size.points}, row.name);
    plot.write(path);
}

/// Reading, reconstruct() and writing in one piece.
double time_whole(const bench::Work& work) {
    const double start = bench::now();
    PointFile file = read_points(work.points_file);
    const double voxel_size = work.cube_extent / static_cast<double>(1u << work.depth);
    const Reconstruction part = reconstruct(std::move(file.cloud), {.voxel_size = voxel_size});
    write_mesh(work.mesh_file, to_polygons(part.mesh), MeshFormat::ply);
    return bench::now() - start;
}

void print_json(const std::vector<Row>& rows, const Size& size, double bandwidth) {
    std::printf("{\"points\": %.0f, \"voxels\": %.0f, \"copy_bytes_per_second\": %.0f, "
                "\"additions_per_second\": %.0f, \"phases\": [",
                size.points, size.voxels, bandwidth, bench::addition_rate());
    for (const Row& row : rows)
        std::printf("%s\n  {\"name\": \"%s\", \"seconds\": %.9f, \"bytes\": %.0f, \"role\": \"%s\"}",
                    &row == rows.data() ? "" : ",", row.name.c_str(), row.seconds, row.bytes,
                    row.role == bench::Role::whole  ? "whole"
                    : row.role == bench::Role::part ? "part"
                                                    : "phase");
    std::printf("]}\n");
}

} // namespace

int bench::phases(int argc, char** argv) {
    CLI::App app(
        "Times every phase of a reconstruction as a function of its own: nanoseconds of a point and of "
        "a voxel, the bytes of the arrays that it reads and makes, and how soon a copy would move them.");
    TimedScan scan;
    scan.add_options(app);
    scan.add_points(app);
    std::string plot_file;
    int threads = 0;
    bool bare = false, json = false;
    app.add_option("--threads", threads, "at most so many; 0: all")->check(CLI::NonNegativeNumber);
    app.add_option("--plot", plot_file, "an SVG file: nanoseconds over bytes");
    app.add_flag("--json", json, "for programs: without what is left of a whole");
    app.add_flag("--bare", bare, "phases and nothing else, without a table: for what counts instructions");
    CLI11_PARSE(app, argc, argv);
    const int used = threads > 0 ? threads : all_threads();
    tbb::task_arena arena(used);
    if (bare) {
        const support::Folder folder;
        Work work = make_work(scan.shape, scan.points, scan.points_per_voxel, folder.path());
        arena.execute([&] { time_steps(work, 1); });
        return 0;
    }
    const double y = sort_seconds(1), bandwidth = copy_bandwidth(used);
    const support::Folder folder;
    Work work = make_work(scan.shape, scan.points, scan.points_per_voxel, folder.path());
    double whole = 0;
    std::vector<Row> rows;
    arena.execute([&] {
        rows = time_steps(work, scan.repeats);
        whole = time_whole(work);
        for (int i = 1; i < scan.repeats && !json; ++i) whole = std::min(whole, time_whole(work));
    });
    const Size size{static_cast<double>(scan.points), static_cast<double>(work.level.size())};
    if (json) {
        print_json(rows, size, bandwidth);
        return 0;
    }
    take_parts_off(rows);
    std::printf("%s, %zu points, %zu voxels, threads: %d; Y %.3f s, copying %.2f GB/s\n\n",
                scan.shape.c_str(), scan.points, work.level.size(), used, y, bandwidth / 1e9);
    print_phases(rows, size, bandwidth);
    std::printf("\nIn one piece, from file to file: %.1f ms, %.2f Y\n", 1e3 * whole, whole / y);
    if (!plot_file.empty()) draw_phases(rows, size, bandwidth, plot_file);
    return 0;
}
