// Clouds that are sampled unevenly: which come out right, without any option; prints the table of
// docs/robustness.md.

#include "benchmarks.hh"

#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/sample.hh"
#include "support/uneven.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

using namespace hsdm;
using namespace hsdm::support;

namespace {

struct UnevenPart {
    const char* name;
    Solid solid;
    long euler;
    std::size_t components = 1, loops = 0;
    double z = Box::inf; // of an open part, what is below this height of the solid
};

std::vector<UnevenPart> uneven_parts() {
    Random random(3);
    const Pose pose = random_pose(random);
    const Pose up = turned({0, 0, 1}, 0);
    const auto tilted_box = [&](const Vec3& size, const Vec3& shift) {
        return box(size).placed({up.rotation, shift});
    };
    return {
        {"sphere", sphere(1), 2},
        {"torus", torus(1, 0.4).placed(pose), 0},
        {"box", box({1.4, 1.1, 0.5}).placed(pose), 2},
        {"cup", (cylinder(0.8, 1.4) - cylinder(0.6, 1.4).placed({.shift = {0, 0, 0.2}})).placed(pose), 2},
        {"fillet", rounded_block(0.35).placed(pose), 2},
        {"bracket", (box({1.4, 1, 1}) - tilted_box({1.1, 1.4, 1}, {0.2, 0.17, 0.3})).placed(pose), 2},
        {"part with shafts", mechanical_part(pose), -4},
        {"plate", box({1, 1, 0.06}).placed(pose), 2},
        {"wedge", wedge(0.5236, 1, 1).placed(pose), 2},
        {"nested spheres", nested_spheres(1, 0.8), 4, 2},
        {"bowl", sphere(1), 1, 1, 1, 0.3},
    };
}

struct UnevenSampling {
    std::string name;
    double share; // of the surface that is dense; 0: density falls with the distance squared
    double ratio;
};

PointCloud uneven_scan(const UnevenPart& part, const UnevenSampling& sampling, double noise,
                       std::uint64_t seed) {
    PointCloud even = sample(part.solid, {.points = 200000, .seed = seed, .position_noise = noise});
    if (part.z < Box::inf) {
        PointCloud below;
        for (std::size_t i = 0; i < even.size(); ++i)
            if (even.positions[i][2] < part.z)
                below.positions.push_back(even.positions[i]), below.normals.push_back(even.normals[i]);
        even = std::move(below);
    }
    const Vec3 side = Vec3(1, 0.35, 0.2).normalized();
    if (sampling.share > 0) return thinned_on_one_side(even, side, sampling.share, sampling.ratio, seed);
    return thinned_by_distance(even, scanner_beside(even, side, sampling.ratio), seed);
}

/// Is the mesh right, and how far from it is the surface on the mean (of points without noise)?
std::pair<bool, double> judged(const UnevenPart& part, PointCloud cloud, NormalSource normals) {
    ReconstructOptions options;
    options.normals = normals;
    const Reconstruction made = reconstruct(std::move(cloud), options);
    const Report::Mesh& m = made.report.mesh;
    const PolygonMesh mesh = to_polygons(made.mesh);
    const bool right = m.boundary_loops == part.loops && m.euler == part.euler
                       && m.components == part.components
                       && find_self_intersections(mesh).facet_pairs.empty();
    const MeshDistance distance(mesh);
    double sum = 0, count = 0;
    for (const Vec3& p : sample(part.solid, {.points = 5000, .seed = 99}).positions)
        if (p[2] < part.z) sum += distance(p), ++count;
    return {right, sum / count};
}

} // namespace

int bench::uneven(int argc, char** argv) {
    CLI::App app("Clouds whose density differs by place: how many come out right, and how near.");
    double ratio = 30, noise = 0.004;
    std::uint64_t seeds = 1;
    bool verbose = false;
    app.add_option("--ratio", ratio, "densest to sparsest, in points to an area")
        ->check(CLI::Range(1.5, 1e4));
    app.add_option("--noise", noise, "standard deviation of the noisy ones");
    app.add_option("--seeds", seeds, "clouds of each part");
    app.add_flag("--verbose", verbose, "says what fails");
    CLI11_PARSE(app, argc, argv);
    std::printf("| sampling | normals | noise | right | mean distance |\n|---|---|---|---|---|\n");
    for (const UnevenSampling& sampling : {UnevenSampling{"falls with the distance", 0, ratio},
                                           {"dense on 10 %", 0.1, ratio},
                                           {"dense on 30 %", 0.3, ratio},
                                           {"dense on 60 %", 0.6, ratio}})
        for (const NormalSource normals : {NormalSource::given, NormalSource::estimate})
            for (const double strength : {0.0, noise}) {
                int right = 0, all = 0;
                double off = 0;
                for (const UnevenPart& part : uneven_parts())
                    for (std::uint64_t seed = 1; seed <= seeds; ++seed, ++all) {
                        const auto [is_right, distance] =
                            judged(part, uneven_scan(part, sampling, strength, seed), normals);
                        right += is_right, off += distance;
                        if (verbose && !is_right)
                            std::fprintf(stderr, "%s, %s, noise %g, seed %d\n", sampling.name.c_str(),
                                         part.name, strength, static_cast<int>(seed));
                    }
                std::printf("| %s | %s | %g | %d of %d | %.5f |\n", sampling.name.c_str(),
                            normals == NormalSource::given ? "given" : "estimated", strength, right, all,
                            off / std::max(all, 1));
                std::fflush(stdout);
            }
    return 0;
}
