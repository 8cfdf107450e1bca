// hsdm_microbench [POINTS...] [--benchmark_...]: every phase of a reconstruction under google-benchmark, as a
// function of its own: filters, repetitions, statistics and JSON are google-benchmark's.

#include "phase_steps.hh"
#include "yard.hh"

#include "hsdm/core/number_of.hh"
#include "support/folder.hh"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>

using namespace hsdm;

namespace {

/// Clouds of all sizes asked for, each as far on its way as some phase needed it.
class Works {
public:
    /// The cloud of this size with all that the step needs.
    bench::Work& before(std::size_t step, std::size_t points) {
        Way& way = ways_[points];
        if (!way.folder) {
            constexpr double points_per_voxel = 7;
            way.folder = std::make_unique<support::Folder>();
            way.work = bench::make_work("torus", points, points_per_voxel, way.folder->path());
        }
        for (; way.done < step; ++way.done) bench::seconds_of(bench::phase_steps()[way.done], way.work);
        return way.work;
    }

private:
    struct Way {
        std::unique_ptr<support::Folder> folder;
        bench::Work work;
        std::size_t done = 0; ///< steps
    };
    std::map<std::size_t, Way> ways_;
};

void time_step(benchmark::State& state, Works& works, std::size_t step, std::size_t points,
               double bandwidth) {
    bench::Work& work = works.before(step, points);
    const bench::Step& timed = bench::phase_steps()[step];
    for (auto _ : state) state.SetIterationTime(bench::seconds_of(timed, work));
    const double bytes = timed.bytes(work);
    constexpr auto per_run = benchmark::Counter::kIsIterationInvariantRate;
    const benchmark::Counter::Flags inverse = per_run | benchmark::Counter::kInvert;
    state.counters["s/point"] = benchmark::Counter(static_cast<double>(points), inverse);
    if (work.level.size() > 0)
        state.counters["s/voxel"] = benchmark::Counter(static_cast<double>(work.level.size()), inverse);
    state.counters["bytes"] = bytes;
    state.counters["bytes/s"] = benchmark::Counter(bytes, per_run);
    state.counters["of copying"] = benchmark::Counter(bytes / bandwidth, per_run);
}

void add_benchmarks(Works& works, std::size_t points, double bandwidth) {
    const std::vector<bench::Step>& steps = bench::phase_steps();
    for (std::size_t i = 0; i < steps.size(); ++i)
        benchmark::RegisterBenchmark((std::string(steps[i].name) + "/" + std::to_string(points)).c_str(),
                                     [&works, i, points, bandwidth](benchmark::State& state) {
                                         time_step(state, works, i, points, bandwidth);
                                     })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
}

} // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    std::vector<std::size_t> sizes;
    for (int i = 1; i < argc; ++i) {
        const auto points = number_of<std::size_t>(argv[i]);
        if (!points || *points < 1000) {
            std::fprintf(stderr,
                         "hsdm_microbench: %s is no number of points, from 1000 on, and no option of "
                         "google-benchmark (--help)\n",
                         argv[i]);
            return 2;
        }
        sizes.push_back(*points);
    }
    if (sizes.empty()) sizes = {100000, 1000000};
    const double bandwidth = bench::copy_bandwidth(0);
    std::fprintf(stderr, "Y %.3f s, copying %.2f GB/s\n", bench::sort_seconds(1), bandwidth / 1e9);
    Works works;
    for (const std::size_t points : sizes) add_benchmarks(works, points, bandwidth);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
