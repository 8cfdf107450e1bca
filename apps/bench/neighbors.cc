// hsdm_bench neighbors: neighbours for normals by the octree and by FLANN's k-d tree: seconds, memory, and
// how good the normals are that come of them.

#include "benchmarks.hh"

#include "hsdm/normals/estimate_normals.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/spatial/neighbor_search.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <malloc.h>
#include <numbers>

using namespace hsdm;

namespace {

/// Kilobytes that a line of /proc/self/status tells of.
double memory(const std::string& line) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0; word == line && status >> kilobytes) return kilobytes;
    return 0;
}

/// Gives back what is free, and lets the most memory in use be told from now on.
void forget_peak() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

Neighbors by_octree(const Octree& octree, int count) {
    return find_neighbors(octree, {.count = count});
}

Neighbors by_kd_tree(const Octree& octree, int count) {
    const NeighborSearch search(octree.positions);
    NearPoints near = search.neighbors(count);
    Neighbors result;
    result.count = near.index.size() / octree.size();
    result.reach.resize(octree.size());
    for (std::size_t i = 0; i < octree.size(); ++i) result.reach[i] = near.distances_of(i).back();
    result.index = std::move(near.index);
    return result;
}

struct Searched {
    Neighbors neighbors;
    double seconds, megabytes;
};

/// The median time of several searches, and what one of them takes beyond what was there.
template <class Search>
Searched measure(const Search& search, int repeats) {
    Searched result;
    std::vector<double> seconds;
    for (int i = 0; i < repeats; ++i) {
        result.neighbors = {};
        forget_peak();
        const double before = memory("VmRSS:"), start = bench::now();
        result.neighbors = search();
        seconds.push_back(bench::now() - start);
        result.megabytes = (memory("VmHWM:") - before) / 1000;
    }
    std::sort(seconds.begin(), seconds.end());
    result.seconds = seconds[seconds.size() / 2];
    return result;
}

struct Errors {
    double mean = 0, most = 0; ///< degrees: of all, and that which 95 % are within
};

/// Angles between estimated normals, of either sign, and the solid's own.
Errors errors_of(const Octree& octree, const Neighbors& neighbors, const PointCloud& truth) {
    const EstimatedNormals estimate = estimate_normals(octree, neighbors);
    const std::vector<Vec3> normals = refined_normals(octree, neighbors, estimate);
    std::vector<double> degrees;
    Errors errors;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const double cosine = std::abs(normals[i] | truth.normals[octree.source[i]]);
        degrees.push_back(std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi);
        errors.mean += degrees.back() / static_cast<double>(octree.size());
    }
    std::sort(degrees.begin(), degrees.end());
    errors.most = degrees[degrees.size() * 95 / 100];
    return errors;
}

/// Share of the nearest points that are among the neighbours; equally near ones are as good.
double recall(const Octree& octree, const Neighbors& found, const Neighbors& exact) {
    constexpr double rounding = 1e-6; // of coordinates in single precision
    std::size_t near = 0;
    for (std::size_t i = 0; i < octree.size(); ++i)
        for (const Index j : found.of(i))
            near += (octree.positions[j] - octree.positions[i]).norm() <= exact.reach[i] * (1 + rounding);
    return static_cast<double>(near) / static_cast<double>(found.index.size());
}

void print(std::size_t points, double noise, int count, const char* name, const Searched& searched,
           double share, const Errors& errors) {
    std::printf("%9zu %6.2f %6d  %-8s %8.3f %8.1f %9.5f %8.3f %8.3f\n", points, noise, count, name,
                searched.seconds, searched.megabytes, share, errors.mean, errors.most);
    std::fflush(stdout);
}

} // namespace

int bench::neighbors(int argc, char** argv) {
    CLI::App app("Neighbours for normals, by the octree and by FLANN's k-d tree.");
    std::vector<std::size_t> sizes{100000, 1000000};
    std::vector<double> noises{0, 0.2, 0.5};
    int repeats = 5, threads = 0, count = 16;
    app.add_option("--sizes", sizes, "numbers of points")->delimiter(',');
    app.add_option("--noise", noises, "standard deviations, in spacings")->delimiter(',');
    app.add_option("--neighbors", count, "per point")->capture_default_str();
    app.add_option("--repeats", repeats, "the median of so many counts")->check(CLI::PositiveNumber);
    app.add_option("--threads", threads, "at most so many; 0: all");
    CLI11_PARSE(app, argc, argv);
    const tbb::global_control bound(tbb::global_control::max_allowed_parallelism,
                                    threads > 0 ? static_cast<std::size_t>(threads) : 1024);

    support::Random random(1);
    const support::Solid solid = support::mechanical_part().placed(support::random_pose(random));
    std::printf("%9s %6s %6s  %-8s %8s %8s %9s %8s %8s\n", "points", "noise", "count", "search", "seconds",
                "MB", "recall", "mean", "95 %");
    for (const std::size_t points : sizes) {
        const double spacing = estimate_spacing(build_octree(support::sample(solid, {.points = points})));
        for (const double noise : noises) {
            const PointCloud cloud =
                support::sample(solid, {.points = points, .position_noise = noise * spacing});
            const Octree octree = build_octree(cloud, {.use_normals = false});
            const Searched tree = measure([&] { return by_kd_tree(octree, count); }, repeats);
            const Searched own = measure([&] { return by_octree(octree, count); }, repeats);
            print(points, noise, count, "octree", own, recall(octree, own.neighbors, tree.neighbors),
                  errors_of(octree, own.neighbors, cloud));
            print(points, noise, count, "FLANN", tree, recall(octree, tree.neighbors, tree.neighbors),
                  errors_of(octree, tree.neighbors, cloud));
        }
    }
    return 0;
}
