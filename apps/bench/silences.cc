// hsdm_bench silences: how long a reconstruction goes on without asking whether it is to, phase by phase.

#include "benchmarks.hh"

#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>

using namespace hsdm;

namespace {

/// The longest time between two calls, by the phase that the first of them told of.
class Silences {
public:
    void heard(const char* phase) {
        const Clock::time_point now = Clock::now();
        double& longest = longest_[phase_];
        longest = std::max(longest, std::chrono::duration<double>(now - last_).count());
        last_ = now;
        phase_ = phase;
    }
    /// Longest first.
    std::vector<std::pair<double, std::string>> ranked() const {
        std::vector<std::pair<double, std::string>> all;
        for (const auto& [phase, seconds] : longest_) all.emplace_back(seconds, phase);
        std::sort(all.rbegin(), all.rend());
        return all;
    }

private:
    using Clock = std::chrono::steady_clock;

    std::map<std::string, double> longest_;
    Clock::time_point last_ = Clock::now();
    std::string phase_ = "(before)";
};

void measure(const PointCloud& cloud, ReconstructOptions options, const std::string& words) {
    Silences silences;
    options.progress = [&](const char* phase, double) {
        silences.heard(phase);
        return true;
    };
    const Report report = reconstruct(cloud, options).report;
    silences.heard("(after)");
    std::printf("%10zu %-10s %8.3f ", cloud.size(), words.c_str(), report.seconds.total);
    constexpr std::size_t rows = 6;
    const auto ranked = silences.ranked();
    for (std::size_t i = 0; i < std::min(rows, ranked.size()); ++i)
        std::printf("  %.3f %s", ranked[i].first, ranked[i].second.c_str());
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int bench::silences(int argc, char** argv) {
    CLI::App app("The longest times between two questions whether to go on, in seconds, and the phases that "
                 "they are in.");
    std::vector<std::size_t> sizes{1000000, 10000000};
    double max_error = 0;
    ReconstructOptions options;
    app.add_option("--sizes", sizes, "numbers of points")->delimiter(',');
    app.add_option("--threads", options.threads, "at most so many; 0: all");
    app.add_option("--max-error", max_error, "share of the diagonal, for adaptive grids; 0: none");
    CLI11_PARSE(app, argc, argv);
    if (max_error > 0) options.max_error = MaxError{max_error, true};

    support::Random random(1);
    const support::Solid solid = support::torus(1, 0.4).placed(support::random_pose(random));
    std::printf("%10s %-10s %8s   longest silences\n", "points", "normals", "total");
    for (const std::size_t points : sizes) {
        PointCloud cloud = support::sample(solid, {.points = points});
        measure(cloud, options, "given");
        cloud.normals = {};
        measure(cloud, options, "estimated");
        if (max_error > 0) continue; // which the basic method does not keep
        options.method = Method::basic;
        measure(cloud, options, "basic");
        options.method = ReconstructOptions().method;
    }
    return 0;
}
