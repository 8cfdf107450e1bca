// Random solids by the thousand, each scanned and reconstructed, and every promise about the mesh checked:
//
//     hsdm_solids_sweep FIRST COUNT
//
// Prints the seeds that break one and a table by how they were scanned; status 1 if there is any. A program
// and not a test, as a hundred thousand take half an hour.

#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"
#include "support/solid.hh"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

using namespace hsdm;

namespace {

constexpr double voxel = 1.0 / 4;
constexpr std::size_t ways = 4;

struct Way {
    const char* name;
    bool normals;
    double noise;        ///< of positions, in voxels
    double normal_noise; ///< radians
};
constexpr std::array<Way, ways> scans{{{"given normals", true, 0, 0},
                                       {"given normals, noise of 0.1 voxel and 5 degrees", true, 0.1, 0.087},
                                       {"no normals", false, 0, 0},
                                       {"no normals, noise of 0.25 voxel", false, 0.25, 0}}};

struct Counts {
    std::array<std::size_t, ways> solids{}, closed{}, refused{}, broken{};
};

/// Eight points a squared voxel of surface; none if hardly anything is left of the solid.
PointCloud scan(std::uint64_t seed, const Way& way) {
    const double walls = seed % 2 ? 0.3 : 2.2; // voxels and more
    const support::Solid solid = support::random_solid(seed, walls * voxel, 3 * walls * voxel);
    constexpr int candidates = 2000;
    support::Random random(seed);
    support::SurfacePoint point;
    int kept = 0;
    for (int i = 0; i < candidates; ++i) kept += solid.sample(random, point);
    const double area = solid.primitive_area() * kept / candidates;
    if (area < voxel * voxel) return {};
    const support::SampleOptions options{.points = static_cast<std::size_t>(8 * area / (voxel * voxel)),
                                         .seed = seed,
                                         .normals = way.normals,
                                         .position_noise = way.noise * voxel,
                                         .normal_noise = way.normal_noise};
    return support::sample(solid, options);
}

std::string bits_of(const PolygonMesh& mesh) {
    std::string bits;
    const auto add = [&](const auto& values) {
        bits.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
    };
    add(mesh.positions);
    add(mesh.corners);
    add(mesh.first);
    add(mesh.normals);
    return bits;
}

bool is_finite(const Report& report) {
    return std::isfinite(report.input.spacing + report.grid.voxel_size + report.error.points_to_mesh_max
                         + report.error.points_to_mesh_mean + report.error.normalised_max);
}

/// Empty, or the promise that was broken.
std::string try_solid(std::uint64_t seed, const PointCloud& cloud, Counts& counts, std::size_t way) {
    ReconstructOptions options;
    options.voxel_size = voxel;
    if (seed % 5 == 0) options.grid = Grid::adaptive;
    if (seed % 7 == 0) options.holes = Holes::close;
    Reconstruction result;
    try {
        result = reconstruct(cloud, options);
    } catch (const Error&) {
        ++counts.refused[way];
        return "";
    }
    const PolygonMesh mesh = to_polygons(result.mesh);
    counts.closed[way] += result.report.mesh.closed;
    const std::string faults = support::faults(mesh);
    if (!faults.empty()) return faults;
    if (!is_finite(result.report)) return "the report holds what is not finite";
    if (seed % 8 != 0) return "";
    PointCloud other = cloud;
    const auto shuffle = [&](auto& values) {
        std::shuffle(values.begin(), values.end(), std::mt19937_64(seed));
    };
    shuffle(other.positions);
    shuffle(other.normals);
    options.threads = 1;
    return bits_of(to_polygons(reconstruct(other, options).mesh)) == bits_of(mesh)
               ? ""
               : "another order, other bits";
}

} // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("hsdm_solids_sweep FIRST COUNT\n", stderr);
        return 2;
    }
    const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10);
    const std::uint64_t solids = std::strtoull(arguments[2], nullptr, 10);
    tbb::enumerable_thread_specific<Counts> all;
    tbb::parallel_for(std::uint64_t{0}, solids, [&](std::uint64_t i) {
        const std::uint64_t seed = first + i;
        const std::size_t way = seed / 2 % ways;
        const PointCloud cloud = scan(seed, scans[way]);
        if (cloud.size() == 0) return;
        Counts counts;
        ++counts.solids[way];
        const std::string broken = try_solid(seed, cloud, counts, way);
        counts.broken[way] += !broken.empty();
        if (!broken.empty())
            std::fprintf(stderr, "seed %llu: %s\n", static_cast<unsigned long long>(seed), broken.c_str());
        Counts& own = all.local();
        for (std::size_t w = 0; w < ways; ++w) {
            own.solids[w] += counts.solids[w];
            own.closed[w] += counts.closed[w];
            own.refused[w] += counts.refused[w];
            own.broken[w] += counts.broken[w];
        }
    });
    Counts sum;
    for (const Counts& own : all)
        for (std::size_t w = 0; w < ways; ++w) {
            sum.solids[w] += own.solids[w];
            sum.closed[w] += own.closed[w];
            sum.refused[w] += own.refused[w];
            sum.broken[w] += own.broken[w];
        }
    std::printf("%-50s %8s %8s %8s %8s\n", "scanned with", "solids", "closed", "refused", "broken");
    std::size_t broken = 0;
    for (std::size_t w = 0; w < ways; ++w) {
        std::printf("%-50s %8zu %8zu %8zu %8zu\n", scans[w].name, sum.solids[w], sum.closed[w],
                    sum.refused[w], sum.broken[w]);
        broken += sum.broken[w];
    }
    return broken == 0 ? 0 : 1;
}
