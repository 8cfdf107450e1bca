// Seconds of each phase over clouds of growing size: the table of docs/benchmark.md.
#include "benchmarks.hh"

#include "hsdm/octree/spacing.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>

using namespace hsdm;

namespace {

/// The cloud with the wanted number of points per voxel on average: the surface occupies voxels in proportion
/// to 1 / h^2, so the right edge follows from the spacing.
double voxel_for(const PointCloud& cloud, double points_per_voxel) {
    constexpr double voxels_per_area = 1.5;
    return estimate_spacing(build_octree(cloud)) * std::sqrt(points_per_voxel * voxels_per_area);
}

Report best_of(const PointCloud& cloud, const ReconstructOptions& options, int repeats) {
    Report best;
    for (int i = 0; i < repeats; ++i) {
        Report report = reconstruct(cloud, options).report;
        if (i == 0 || report.seconds.total < best.seconds.total) best = std::move(report);
    }
    return best;
}

} // namespace

int bench::phases(int argc, char** argv) {
    CLI::App app("Times the phases of a reconstruction over clouds of growing size.");
    std::vector<std::size_t> sizes{100000, 300000, 1000000, 3000000, 10000000};
    double points_per_voxel = 8;
    int repeats = 3, threads = 0;
    app.add_option("--sizes", sizes, "numbers of points")->delimiter(',');
    app.add_option("--points-per-voxel", points_per_voxel, "on average")->capture_default_str();
    app.add_option("--repeats", repeats, "the fastest of so many runs counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--threads", threads, "at most so many; 0: all");
    CLI11_PARSE(app, argc, argv);

    support::Random random(1);
    const support::Solid solid = support::torus(1, 0.4).placed(support::random_pose(random));
    std::printf("%10s %10s %8s %8s %8s %8s %8s %8s %8s %12s %8s\n", "points", "voxels", "octree", "graph",
                "facets", "error", "mesh", "features", "total", "ns / point", "MB");
    for (std::size_t points : sizes) {
        const PointCloud cloud = support::sample(solid, {.points = points, .normals = false});
        const ReconstructOptions options{
            .voxel_size = voxel_for(cloud, points_per_voxel), .method = Method::basic, .threads = threads};
        const Report r = best_of(cloud, options, repeats);
        const Report::Seconds& s = r.seconds;
        std::printf("%10zu %10zu %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %12.1f %8zu\n", points,
                    r.grid.voxels, s.octree, s.graph, s.facets, s.error, s.mesh, s.features, s.total,
                    1e9 * s.total / static_cast<double>(points), r.peak_memory_bytes / 1000000);
        std::fflush(stdout);
    }
    return 0;
}
