// hsdm_bench threads: how much sooner every phase is done by more threads.

#include "benchmarks.hh"
#include "phase_steps.hh"
#include "plot.hh"
#include "timed_scan.hh"
#include "yard.hh"

#include "support/folder.hh"
#include "support/named_solid.hh"

#include <CLI/CLI.hpp>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>

using namespace hsdm;

namespace {

/// Per step and number of threads, the fastest of so many runs, the numbers by turns.
std::vector<std::vector<double>> time_by_threads(bench::Work& work, const std::vector<int>& threads,
                                                 int repeats) {
    std::vector<std::vector<double>> seconds;
    for (const bench::Step& step : bench::phase_steps()) {
        std::vector<double>& best = seconds.emplace_back(threads.size(), 1e300);
        for (int i = 0; i < repeats; ++i)
            for (std::size_t t = 0; t < threads.size(); ++t) {
                tbb::task_arena arena(threads[t]);
                arena.execute([&] { best[t] = std::min(best[t], bench::seconds_of(step, work)); });
            }
    }
    return seconds;
}

void print_ratio(const std::string& name, const std::vector<double>& seconds) {
    std::printf("| %s |", name.c_str());
    for (const double s : seconds) std::printf(" %.1f |", 1e3 * s);
    std::printf(" %.2f |\n", seconds.front() / seconds.back());
}

} // namespace

int bench::threads(int argc, char** argv) {
    CLI::App app("Milliseconds of every phase by the number of threads, and how often the last goes into the "
                 "first.");
    TimedScan scan;
    scan.add_options(app);
    scan.add_points(app);
    std::string plot_file;
    std::vector<int> threads{1, 2};
    app.add_option("--threads", threads, "how many, the least first")
        ->delimiter(',')
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--plot", plot_file, "an SVG file: the ratio over the time of the least");
    CLI11_PARSE(app, argc, argv);
    const support::Folder folder;
    Work work = make_work(scan.shape, scan.points, scan.points_per_voxel, folder.path());
    const auto seconds = time_by_threads(work, threads, scan.repeats);

    std::printf("%s, %zu points, %zu voxels; Y %.3f s\n\n| phase |", scan.shape.c_str(), scan.points,
                work.level.size(), sort_seconds(1));
    for (const int t : threads) std::printf(" ms by %d |", t);
    std::printf(" ratio |\n|---|---|");
    for (std::size_t t = 0; t < threads.size(); ++t) std::printf("---|");
    std::printf("\n");
    constexpr double shortest = 1e-3; // seconds
    const double most = static_cast<double>(threads.back()) / threads.front();
    Plot plot({"ms by the least number of threads", 1, 1000, round_ticks(1, 1000)},
              {"times as fast by the greatest", 0, 1.2 * most, {0, 0.5 * most, 0.75 * most, most}, false});
    std::vector<double> all(threads.size(), 0.0);
    const std::vector<Step>& steps = phase_steps();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        print_ratio(steps[i].name, seconds[i]);
        if (seconds[i].front() >= shortest) // others have no time to divide
            plot.mark({1e3 * seconds[i].front(), seconds[i].front() / seconds[i].back()}, steps[i].name);
        for (std::size_t t = 0; t < threads.size() && steps[i].role != Role::part; ++t)
            all[t] += seconds[i][t];
    }
    print_ratio("all", all);
    if (!plot_file.empty()) plot.write(plot_file);
    return 0;
}
