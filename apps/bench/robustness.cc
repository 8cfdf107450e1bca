// Where does topology break? Three solids, faults of growing strength, normals given and estimated; prints
// the table of docs/robustness.md.

#include "benchmarks.hh"

#include "hsdm/errors.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/reconstruct.hh"
#include "support/pose.hh"
#include "support/random.hh"
#include "support/sample.hh"
#include "support/trial.hh"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <string>

using namespace hsdm;

namespace {

constexpr double fixed_voxel = 0.1;
constexpr double points_a_voxel = 8; // points per squared voxel

struct ScannedSolid {
    const char* name;
    support::Solid solid;
    std::size_t points; // so that there are `points_a_voxel` on a squared voxel
    long euler;
};

struct Fault {
    const char* name;
    std::vector<double> strengths;
};

const std::vector<Fault> faults = {
    {"position noise, voxels", {0, 0.1, 0.25, 0.5, 1}},
    {"normal noise, degrees", {0, 5, 10, 20, 30}},
    {"outliers, %", {0, 1, 2, 5, 10}},
    {"densest to sparsest", {1, 2, 5, 10, 20}},
    {"normals flipped, %", {0, 5, 10, 20, 50}},
    {"points per voxel", {8, 4, 2, 1.5, 1}},
    {"blobs of 12 strays", {1, 5, 20, 50, 100}},
    {"two scans apart, voxels", {0.1, 0.2, 0.3, 0.5, 1}},
};

/// Points left out at random, the more the farther along x.
void thin_out(PointCloud& cloud, double ratio, support::Random& random) {
    const Box box = cloud.bounds();
    PointCloud kept;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double along = (cloud.positions[i][0] - box.lo[0]) / (box.hi[0] - box.lo[0]);
        if (random.uniform(0, 1) > 1 / (1 + along * (ratio - 1))) continue;
        kept.positions.push_back(cloud.positions[i]);
        kept.normals.push_back(cloud.normals[i]);
    }
    cloud = std::move(kept);
}

/// Blobs a spacing wide, anywhere in the box; their normals are any.
void add_blobs(PointCloud& cloud, double count, support::Random& random) {
    const Box box = cloud.bounds();
    for (double blob = 0; blob < count; ++blob) {
        Vec3 at;
        for (unsigned k = 0; k < 3; ++k) at[k] = random.uniform(box.lo[k], box.hi[k]);
        for (int i = 0; i < 12; ++i) {
            cloud.positions.push_back(at + random.direction() * (fixed_voxel / std::sqrt(points_a_voxel)));
            cloud.normals.push_back(random.direction());
        }
    }
}

/// The same solid scanned again, the second scan moved rigidly.
void add_moved_scan(PointCloud& cloud, const ScannedSolid& shape, support::SampleOptions options,
                    double apart) {
    options.seed += 1;
    const PointCloud second = support::sample(shape.solid, options);
    const Vec3 shift = Vec3(0.6, 0.5, 0.62).normalized() * apart;
    for (const Vec3& p : second.positions) cloud.positions.push_back(p + shift);
    cloud.normals.insert(cloud.normals.end(), second.normals.begin(), second.normals.end());
}

PointCloud scan(const ScannedSolid& shape, std::size_t fault, double strength) {
    support::SampleOptions options;
    options.points = shape.points;
    options.seed = 7;
    if (fault == 0) options.position_noise = strength * fixed_voxel;
    if (fault == 1) options.normal_noise = strength * 0.0174533;
    if (fault == 2) options.outliers = strength / 100;
    // The dense end gets more points, so that the sparse one has as many per voxel as half of the others.
    if (fault == 3)
        options.points = static_cast<std::size_t>(static_cast<double>(shape.points) * (1 + strength) / 2);
    if (fault == 5)
        options.points =
            static_cast<std::size_t>(static_cast<double>(shape.points) * strength / points_a_voxel);
    PointCloud cloud = support::sample(shape.solid, options);
    support::Random random(11);
    if (fault == 3) thin_out(cloud, strength, random);
    if (fault == 6) add_blobs(cloud, strength, random);
    if (fault == 7) add_moved_scan(cloud, shape, options, strength * fixed_voxel);
    if (fault == 4)
        for (Vec3& n : cloud.normals)
            if (random.uniform(0, 1) < strength / 100) n = -n;
    return cloud;
}

std::string outcome(const ScannedSolid& shape, const PointCloud& cloud, NormalSource normals, bool choose) {
    ReconstructOptions options;
    if (!choose) options.voxel_size = fixed_voxel;
    options.normals = normals;
    try {
        const Report report = reconstruct(cloud, options).report;
        const Report::Mesh& m = report.mesh;
        if (m.closed && m.components == 1 && m.euler == shape.euler) return "right";
        if (!m.closed) return std::to_string(m.boundary_loops) + " holes";
        return m.components != 1 ? std::to_string(m.components) + " parts"
                                 : "genus " + std::to_string(m.genus);
    } catch (const Error& error) {
        return "refused";
    }
}

/// How many of the solids with large features of a range of seeds come out with the right topology under
/// position noise.
void print_random_solids(std::uint64_t first_seed, std::uint64_t last_seed, NormalSource normals,
                         bool choose) {
    const std::vector<double> noises = {0, 0.25, 0.5};
    std::vector<int> right(noises.size(), 0);
    int solids = 0;
    const support::TrialOptions how{.voxel = fixed_voxel};
    for (std::uint64_t seed = first_seed; seed < last_seed; ++seed) {
        const support::Trial trial = support::make_trial(seed, how);
        if (trial.size != support::FeatureSize::large) continue;
        ++solids;
        const support::Solid solid =
            support::random_solid(seed, how.thinnest * fixed_voxel, how.thickest * fixed_voxel);
        for (std::size_t k = 0; k < noises.size(); ++k) {
            ReconstructOptions options;
            if (!choose) options.voxel_size = fixed_voxel;
            options.normals = normals;
            const PointCloud cloud = support::sample(
                solid,
                {.points = trial.cloud.size(), .seed = seed, .position_noise = noises[k] * fixed_voxel});
            const Report::Mesh m = reconstruct(cloud, options).report.mesh;
            right[k] += m.closed && m.euler == trial.euler;
        }
    }
    std::printf("| %-24s | %-16s | %-8s |", faults[0].name, "random solids",
                normals == NormalSource::given ? "given" : "none");
    for (std::size_t k = 0; k < noises.size(); ++k)
        std::printf(" %g: %d of %d |", noises[k], right[k], solids);
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int bench::robustness(int argc, char** argv) {
    CLI::App app("Clouds with growing faults: which come out as one closed surface of the right topology.");
    std::string wanted;
    app.add_option("fault", wanted, "only those whose name holds this");
    CLI11_PARSE(app, argc, argv);
    support::Random random(3);
    const support::Pose pose = support::random_pose(random);
    const std::vector<ScannedSolid> shapes = {
        {"mechanical part", support::mechanical_part(pose), 40000, -4},
        {"torus", support::torus(1, 0.4).placed(pose), 12600, 0},
        {"box", support::box({1.4, 1.1, 0.5}).placed(pose), 4500, 2},
    };
    for (bool choose : {false, true}) {
        std::printf("\n%s\n", choose ? "voxel chosen from the cloud" : "voxel fixed");
        for (std::size_t f = 0; f < faults.size(); ++f) {
            if (std::string(faults[f].name).find(wanted) == std::string::npos) continue;
            for (const ScannedSolid& shape : shapes)
                for (NormalSource normals : {NormalSource::given, NormalSource::estimate}) {
                    std::printf("| %-24s | %-16s | %-8s |", faults[f].name, shape.name,
                                normals == NormalSource::given ? "given" : "none");
                    for (double strength : faults[f].strengths)
                        std::printf(" %g: %s |", strength,
                                    outcome(shape, scan(shape, f, strength), normals, choose).c_str());
                    std::printf("\n");
                    std::fflush(stdout);
                }
        }
        if (std::string(faults[0].name).find(wanted) == std::string::npos) continue;
        for (NormalSource normals : {NormalSource::given, NormalSource::estimate})
            print_random_solids(200, 320, normals, choose);
    }
    return 0;
}
