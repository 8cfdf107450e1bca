// How blunt may an edge be and still come out sharp? Regular prisms of many sides: the table of
// docs/sheets.md.

#include "benchmarks.hh"
#include "segment.hh"

#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/reconstruct.hh"
#include "support/pose.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

using namespace hsdm;

namespace {

constexpr double points_per_square = 8; // per squared edge
constexpr double prism_height = 1;
constexpr double near_by = 0.25; // voxels: an edge as far off is found

using bench::Segment;
using Lines = std::vector<Segment>;

/// Share of the length of `these` that is near one of `those`.
double share_near(const Lines& these, const Lines& those, double tolerance) {
    double near = 0, all = 0;
    for (const Segment& s : these) {
        constexpr int pieces = 64;
        const double length = (s.to - s.from).norm();
        for (int i = 0; i < pieces; ++i) {
            const Vec3 p = s.from + (s.to - s.from) * ((i + 0.5) / pieces);
            all += length;
            if (std::ranges::any_of(those, [&](const Segment& t) { return distance(p, t) <= tolerance; }))
                near += length;
        }
    }
    return all > 0 ? near / all : 1;
}

/// Edges of a mesh that fold it by more than an angle.
Lines folds(const PolyMesh& mesh, double angle) {
    Lines found;
    for (const auto e : mesh.edges()) {
        if (e.is_boundary()) continue;
        const auto h = e.h0();
        if (angle_between(mesh.calc_face_normal(h.face()), mesh.calc_face_normal(h.opp().face())) > angle)
            found.push_back({mesh.point(h.from()), mesh.point(h.to())});
    }
    return found;
}

struct Edges {
    Lines blunt, all;
};

Edges edges_of_prism(int sides, const support::Pose& pose) {
    const double turn = 2 * std::numbers::pi / sides, radius = 0.5 / std::cos(turn / 2);
    const auto corner = [&](int i, double z) {
        const double at = (i + 0.5) * turn;
        return pose.to_world({radius * std::cos(at), radius * std::sin(at), z});
    };
    Edges edges;
    for (int i = 0; i < sides; ++i) {
        edges.blunt.push_back({corner(i, -prism_height / 2), corner(i, prism_height / 2)});
        for (const double z : {-prism_height / 2, prism_height / 2})
            edges.all.push_back({corner(i, z), corner(i + 1, z)});
    }
    edges.all.insert(edges.all.end(), edges.blunt.begin(), edges.blunt.end());
    return edges;
}

struct Found {
    double recall = 0, precision = 0;
};

/// Means over poses. `noise` is of points in spacings, and of normals in units of 50 degrees.
Found found_in_prisms(int sides, double voxels_across_side, NormalSource normals, double noise,
                      std::uint64_t poses) {
    const double turn = 2 * std::numbers::pi / sides;
    const double voxel = std::tan(turn / 2) / voxels_across_side;
    const double area = std::tan(turn / 2) * sides * (prism_height + 0.5);
    Found sum;
    for (std::uint64_t seed = 1; seed <= poses; ++seed) {
        const support::Pose pose = support::random_pose(seed);
        const PointCloud cloud =
            support::sample(support::prism(sides, 1, prism_height).placed(pose),
                            {.points = static_cast<std::size_t>(points_per_square * area / (voxel * voxel)),
                             .seed = seed,
                             .position_noise = noise * voxel / std::sqrt(points_per_square),
                             .normal_noise = noise * 50 * std::numbers::pi / 180});
        const PolyMesh mesh =
            reconstruct(cloud, {.voxel_size = voxel, .normals = normals, .classify = false}).mesh;
        const Edges edges = edges_of_prism(sides, pose);
        const Lines found = folds(mesh, turn / 2);
        sum.recall += share_near(edges.blunt, found, near_by * voxel) / static_cast<double>(poses);
        sum.precision += share_near(found, edges.all, near_by * voxel) / static_cast<double>(poses);
    }
    return sum;
}

} // namespace

int bench::creases(int argc, char** argv) {
    CLI::App app(
        "Recall and precision, in percent, of the edges of prisms: of a mesh's edges those count that "
        "fold it by more than half of what the true ones do, within a quarter of a voxel.");
    std::uint64_t poses = 5;
    double across = 4;
    app.add_option("--poses", poses, "of each prism");
    app.add_option("--across", across, "voxels across a side of the prism");
    CLI11_PARSE(app, argc, argv);
    std::printf("| turn | normals given | normals estimated | noise |\n|---|---|---|---|\n");
    for (const int sides : {24, 18, 14, 12, 10, 8, 6}) {
        std::printf("| %.0f degrees |", 360.0 / sides);
        for (const auto& [normals, noise] : {std::pair(NormalSource::given, 0.0),
                                             {NormalSource::estimate, 0.0},
                                             {NormalSource::given, 0.1}}) {
            const Found s = found_in_prisms(sides, across, normals, noise, poses);
            std::printf(" %.0f, %.0f |", 100 * s.recall, 100 * s.precision);
            std::fflush(stdout);
        }
        std::printf("\n");
    }
    return 0;
}
