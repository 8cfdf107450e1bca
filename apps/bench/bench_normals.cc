// hsdm_bench_normals: accuracy and seconds of estimated normals, against the normals that the file gives.

#include "hsdm/io/read_points.hh"
#include "hsdm/normals/normals.hh"
#include "hsdm/octree/spacing.hh"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

using namespace hsdm;

namespace {

struct Segment {
    Vec3 from, to;
};

/// Lines `e x y z x y z ...` of a file of sharp edges.
std::vector<Segment> read_edges(const std::string& path) {
    std::vector<Segment> edges;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind;
        Segment s;
        if (words >> kind && kind == "e"
            && words >> s.from[0] >> s.from[1] >> s.from[2] >> s.to[0] >> s.to[1] >> s.to[2])
            edges.push_back(s);
    }
    return edges;
}

double distance(const Vec3& p, const Segment& s) {
    const Vec3 along = s.to - s.from;
    const double length = along.sqrnorm();
    const double t = length > 0 ? std::clamp(((p - s.from) | along) / length, 0.0, 1.0) : 0;
    return (p - s.from - along * t).norm();
}

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Score {
    std::size_t smooth = 0, near_crease = 0, off_smooth = 0, off_crease = 0, flipped = 0;
    double sum_smooth = 0, sum_crease = 0;
};

/// Against the normals of the cloud, at the points as they were read.
Score judge(const Octree& octree, const PointCloud& cloud, const std::vector<Segment>& edges, double reach) {
    Score score;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const Vec3 p = cloud.positions[octree.source[i]];
        const double c = octree.normals[i] | cloud.normals[octree.source[i]].normalized();
        const double angle = std::acos(std::min(1.0, std::abs(c))) * 180 / std::numbers::pi;
        const bool crease =
            std::any_of(edges.begin(), edges.end(), [&](const Segment& s) { return distance(p, s) < reach; });
        score.flipped += c < 0;
        (crease ? score.near_crease : score.smooth) += 1;
        (crease ? score.sum_crease : score.sum_smooth) += angle;
        if (angle > 15) (crease ? score.off_crease : score.off_smooth) += 1;
    }
    return score;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Estimates the normals of clouds that have some and compares. Arguments: CLOUD[:EDGES] ...");
    std::vector<std::string> inputs;
    app.add_option("cloud", inputs, "point file with exact normals, then a colon and a file of sharp edges")
        ->required();
    NormalsOptions options;
    app.add_option("--tolerance", options.estimate.least_tolerance)->capture_default_str();
    app.add_option("--noise-tolerance", options.estimate.noise_tolerance)->capture_default_str();
    app.add_option("--rounds", options.estimate.rounds)->capture_default_str();
    app.add_option("--neighbors", options.neighbors, "per point; 0: by the noise")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    std::printf("%-24s %8s %7s %7s %7s | smooth: %6s %6s | crease: %8s %6s %6s | %8s | %7s\n", "cloud",
                "points", "noise", "moved", "refit%", "deg", ">15%", "points", "deg", ">15%", "flipped%",
                "seconds");
    for (const std::string& input : inputs) {
        const std::size_t colon = input.find(':');
        const PointCloud cloud = read_points(input.substr(0, colon)).cloud;
        std::vector<Segment> edges;
        if (colon != std::string::npos) edges = read_edges(input.substr(colon + 1));
        Octree octree = build_octree(cloud, {.use_normals = false});
        const double h = octree.voxel_size(choose_depth(octree, estimate_spacing(octree)).depth);
        const double start = now();
        const NormalsReport report = make_normals(octree, options);
        const double seconds = now() - start;
        const Score s = judge(octree, cloud, edges, 2 * h);
        const auto share = [](auto part, std::size_t whole) {
            return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
        };
        std::printf("%-24s %8zu %7.4f %7.4f %7.2f | %14.2f %6.2f | %16zu %6.2f %6.2f | %8.3f | %7.3f\n",
                    std::filesystem::path(input.substr(0, colon)).stem().c_str(), octree.size(), report.noise,
                    report.smoothed.noise, 100 * share(report.bent, octree.size()),
                    share(s.sum_smooth, s.smooth), 100 * share(s.off_smooth, s.smooth), s.near_crease,
                    share(s.sum_crease, s.near_crease), 100 * share(s.off_crease, s.near_crease),
                    100 * share(s.flipped, octree.size()), seconds);
    }
    return 0;
}
