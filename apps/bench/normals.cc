// hsdm_bench normals: accuracy and seconds of estimated normals, against the normals that the file gives or
// those of the shape itself.

#include "benchmarks.hh"

#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/normals/normals.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "support/segment.hh"

#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

using namespace hsdm;

namespace {

using support::Segment;

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

/// Normals of the surface that a mesh of triangles stands for: those at the corners, means over the facets
/// around that are bent by less than a crease, interpolated. So facets of a smooth shape leave no steps.
class TrueShape {
public:
    explicit TrueShape(const PolygonMesh& mesh)
        : mesh_(mesh), distance_(mesh), normals_(mesh.corners.size()) {
        std::vector<Vec3> areas(mesh.facet_count());
        std::vector<std::vector<std::size_t>> around(mesh.vertex_count());
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto [a, b, c] = corners(f);
            areas[f] = (b - a) % (c - a);
            for (Index v : mesh.facet(f)) around[v].push_back(f);
        }
        for (std::size_t f = 0; f < mesh.facet_count(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                normals_[mesh.first[f] + k] = mean(areas, around[mesh.facet(f)[k]], f);
    }

    Vec3 normal(const Vec3& point) const {
        const Index f = distance_.nearest_facet(point);
        const auto [a, b, c] = corners(f);
        const Vec3 area = (b - a) % (c - a), d = point - a;
        const double inverse = 1 / std::max(area.sqrnorm(), 1e-300);
        // Beside the facet, its nearest point is near enough for an angle.
        const double v = std::clamp(((d % (c - a)) | area) * inverse, 0.0, 1.0);
        const double w = std::clamp((((b - a) % d) | area) * inverse, 0.0, 1.0 - v);
        const Vec3* const n = &normals_[mesh_.first[f]];
        return (n[0] * (1 - v - w) + n[1] * v + n[2] * w).normalized();
    }

private:
    std::array<Vec3, 3> corners(std::size_t f) const {
        const auto facet = mesh_.facet(f);
        return {mesh_.positions[facet[0]], mesh_.positions[facet[1]], mesh_.positions[facet[2]]};
    }
    static Vec3 mean(const std::vector<Vec3>& areas, const std::vector<std::size_t>& around, std::size_t f) {
        constexpr double cos_crease = 0.85; // 32 degrees
        Vec3 sum = areas[f] * 1e-6;         // a facet of no area has no normal to compare with
        for (std::size_t other : around)
            if ((areas[f] | areas[other]) >= cos_crease * areas[f].norm() * areas[other].norm())
                sum += areas[other];
        return sum.sqrnorm() > 0 ? sum.normalized() : sum;
    }

    const PolygonMesh& mesh_;
    MeshDistance distance_;
    std::vector<Vec3> normals_; // per corner
};

/// `CLOUD[:EDGES[:SHAPE]]`, parts that are not given empty.
std::array<std::string, 3> split(const std::string& input) {
    std::array<std::string, 3> parts;
    std::istringstream text(input);
    for (std::string& part : parts) std::getline(text, part, ':');
    return parts;
}

double degrees(double cosine) {
    return std::acos(std::min(1.0, std::abs(cosine))) * 180 / std::numbers::pi;
}

struct Score {
    std::size_t smooth = 0, near_crease = 0, off_smooth = 0, off_crease = 0, flipped = 0;
    double sum_smooth = 0, sum_crease = 0;
    double sum_file = 0; ///< of the file's own normals, on smooth parts
};

/// Against the true normals, at the points as they were read.
Score judge(const Octree& octree, const PointCloud& cloud, const std::vector<Vec3>& truth,
            const std::vector<Segment>& edges, double reach) {
    Score score;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const Vec3 p = cloud.positions[octree.source[i]];
        const Vec3& exact = truth[octree.source[i]];
        const double c = octree.normals[i] | exact, angle = degrees(c);
        const bool crease =
            std::any_of(edges.begin(), edges.end(), [&](const Segment& s) { return distance(p, s) < reach; });
        score.flipped += c < 0;
        (crease ? score.near_crease : score.smooth) += 1;
        (crease ? score.sum_crease : score.sum_smooth) += angle;
        if (!crease) score.sum_file += degrees(cloud.normals[octree.source[i]].normalized() | exact);
        if (angle > 15) (crease ? score.off_crease : score.off_smooth) += 1;
    }
    return score;
}

std::vector<Vec3> true_normals(const PointCloud& cloud, const std::string& shape_path) {
    std::vector<Vec3> normals(cloud.size());
    if (shape_path.empty()) {
        for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = cloud.normals[i].normalized();
        return normals;
    }
    const PolygonMesh mesh = read_mesh(shape_path);
    const TrueShape shape(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = shape.normal(cloud.positions[i]);
    return normals;
}

} // namespace

int bench::normals(int argc, char** argv) {
    CLI::App app("Estimates the normals of clouds that have some and compares. "
                 "Arguments: CLOUD[:EDGES[:SHAPE]] ...");
    std::vector<std::string> inputs;
    app.add_option("cloud", inputs,
                   "point file with normals, then a colon and a file of sharp edges, then a colon and a mesh "
                   "whose normals are to be compared with instead")
        ->required();
    NormalsOptions options;
    app.add_option("--tolerance", options.estimate.least_tolerance)->capture_default_str();
    app.add_option("--noise-tolerance", options.estimate.noise_tolerance)->capture_default_str();
    app.add_option("--rounds", options.estimate.rounds)->capture_default_str();
    app.add_option("--neighbors", options.neighbors, "per point; 0: by the noise")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    std::printf("%-24s %8s %7s %7s %7s | smooth: %6s %6s %6s | crease: %8s %6s %6s | %8s | %7s\n", "cloud",
                "points", "noise", "moved", "refit%", "deg", ">15%", "file's", "points", "deg", ">15%",
                "flipped%", "seconds");
    for (const std::string& input : inputs) {
        const auto [cloud_path, edges_path, shape_path] = split(input);
        const PointCloud cloud = read_points(cloud_path).cloud;
        const std::vector<Segment> edges = read_edges(edges_path);
        Octree octree = build_octree(cloud, {.use_normals = false});
        const double h = octree.voxel_size(choose_depth(octree, estimate_spacing(octree)).depth);
        const double start = bench::now();
        const NormalsReport report = make_normals(octree, options);
        const double seconds = bench::now() - start;
        const Score s = judge(octree, cloud, true_normals(cloud, shape_path), edges, 2 * h);
        const auto share = [](auto part, std::size_t whole) {
            return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
        };
        std::printf("%-24s %8zu %7.4f %7.4f %7.2f | %14.2f %6.2f %6.2f | %16zu %6.2f %6.2f | %8.3f | %7.3f\n",
                    std::filesystem::path(cloud_path).stem().c_str(), octree.size(), report.noise,
                    report.smoothed.noise, 100 * share(report.bent, octree.size()),
                    share(s.sum_smooth, s.smooth), 100 * share(s.off_smooth, s.smooth),
                    share(s.sum_file, s.smooth), s.near_crease, share(s.sum_crease, s.near_crease),
                    100 * share(s.off_crease, s.near_crease), 100 * share(s.flipped, octree.size()), seconds);
    }
    return 0;
}
