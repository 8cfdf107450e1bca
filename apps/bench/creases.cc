// How blunt may an edge be, how narrow a chamfer, and still come out sharp? Regular prisms of many sides, and
// bars with chamfers: the tables of docs/sheets.md.

#include "benchmarks.hh"

#include "hsdm/reconstruct.hh"
#include "support/edges.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

using namespace hsdm;

namespace {

constexpr double points_per_square = 8; // per squared edge
constexpr double near_by = 0.25;        // voxels: an edge as far off is found

struct Found {
    double recall = 0, precision = 0;
};

PointCloud scan_of(const support::EdgedSolid& part, double voxel, double noise, std::uint64_t seed) {
    return support::sample(
        part.solid, {.points = static_cast<std::size_t>(points_per_square * part.area / (voxel * voxel)),
                     .seed = seed,
                     .position_noise = noise * voxel / std::sqrt(points_per_square),
                     .normal_noise = noise * 50 * std::numbers::pi / 180});
}

/// Means over poses. An edge is found where the mesh folds by more than `fold`. `noise` is of points in
/// spacings, and of normals in units of 50 degrees.
Found found_in(const support::EdgedSolid& part, double fold, double voxel, NormalSource normals, double noise,
               std::uint64_t poses) {
    Found sum;
    for (std::uint64_t seed = 1; seed <= poses; ++seed) {
        const support::EdgedSolid edged = support::placed(part, support::random_pose(seed));
        const PolyMesh mesh = reconstruct(scan_of(edged, voxel, noise, seed),
                                          {.voxel_size = voxel, .normals = normals, .classify = false})
                                  .mesh;
        const support::Lines found = support::folds(mesh, fold);
        sum.recall += support::share_near(edged.blunt, found, near_by * voxel) / static_cast<double>(poses);
        sum.precision += support::share_near(found, edged.all, near_by * voxel) / static_cast<double>(poses);
    }
    return sum;
}

/// Share of the fillets of a bar that is marked as sharp, in percent.
double marked_of(double radius, double voxel, NormalSource normals, double noise, std::uint64_t poses) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= poses; ++seed) {
        const support::EdgedSolid bar =
            support::placed(support::filleted_bar(radius), support::random_pose(seed));
        const PolyMesh mesh =
            reconstruct(scan_of(bar, voxel, noise, seed), {.voxel_size = voxel, .normals = normals}).mesh;
        const double tolerance = near_by * voxel + std::numbers::pi / 4 * radius; // half of its arc
        sum += support::share_near(bar.blunt, support::marked(mesh), tolerance) / static_cast<double>(poses);
    }
    return 100 * sum;
}

/// With given normals, with estimated ones, with noise.
constexpr std::array normal_columns{std::pair(NormalSource::given, 0.0),
                                    std::pair(NormalSource::estimate, 0.0),
                                    std::pair(NormalSource::given, 0.1)};

void print_found(const support::EdgedSolid& part, double fold, double voxel, std::uint64_t poses) {
    for (const auto& [normals, noise] : normal_columns) {
        const Found s = found_in(part, fold, voxel, normals, noise, poses);
        std::printf(" %.0f, %.0f |", 100 * s.recall, 100 * s.precision);
        std::fflush(stdout);
    }
    std::printf("\n");
}

} // namespace

int bench::creases(int argc, char** argv) {
    CLI::App app(
        "Recall and precision, in percent, of the edges of prisms and of chamfers: of a mesh's "
        "edges those count "
        "that fold it by more than half of what the true ones do, within a quarter of a voxel. Percent of "
        "fillets that are marked as sharp.");
    std::uint64_t poses = 5;
    double across = 4;
    app.add_option("--poses", poses, "of each part");
    app.add_option("--across", across, "voxels across a side of the prism");
    CLI11_PARSE(app, argc, argv);
    std::printf("| turn | normals given | normals estimated | noise |\n|---|---|---|---|\n");
    for (const int sides : {24, 18, 14, 12, 10, 8, 6}) {
        std::printf("| %.0f degrees |", 360.0 / sides);
        const double turn = 2 * std::numbers::pi / sides;
        print_found(support::edged_prism(sides), turn / 2, std::tan(turn / 2) / across, poses);
    }
    std::printf("\n| chamfer | normals given | normals estimated | noise |\n|---|---|---|---|\n");
    constexpr double voxel = 1.0 / 16;
    for (const double degrees : {45.0, 36.0})
        for (const double width : {0.5, 0.75, 1.0, 1.5, 2.0}) {
            std::printf("| %.4g voxels, %.0f degrees |", width, degrees);
            const double turn = degrees * std::numbers::pi / 180;
            print_found(support::chamfered_bar(width * voxel, turn), turn / 2, voxel, poses);
        }
    std::printf("\n| fillet | normals given | normals estimated | noise |\n|---|---|---|---|\n");
    for (const double radius : {0.5, 0.75, 1.0, 1.5, 2.0}) {
        std::printf("| %.4g voxels |", radius);
        for (const auto& [normals, noise] : normal_columns)
            std::printf(" %.0f |", marked_of(radius * voxel, voxel, normals, noise, poses));
        std::printf("\n");
    }
    return 0;
}
