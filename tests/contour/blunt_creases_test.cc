#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numbers>

using namespace hsdm;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A point at height f(x) over the square [-0.5, 0.5]^2, facing up, with a normal off by some noise.
template <class Height, class Slope>
std::vector<CreaseSample> relief(std::size_t count, std::uint64_t seed, double noise, Height height,
                                 Slope slope) {
    support::Random random(seed);
    std::vector<CreaseSample> samples;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = random.uniform() - 0.5;
        const double y = random.uniform() - 0.5;
        Vec3 normal(-slope(x), 0, 1);
        normal.normalize();
        normal += random.gauss3() * noise;
        samples.push_back({Vec3(x, y, height(x)), normal.normalized()});
    }
    return samples;
}

/// Two faces that turn by an angle at `at`; a negative one is a valley.
std::vector<CreaseSample> roof(double angle, double at, std::uint64_t seed, double noise = 0) {
    const double slope = std::tan(angle / 2);
    return relief(
        24, seed, noise, [=](double x) { return -slope * std::abs(x - at); },
        [=](double x) { return x < at ? slope : -slope; });
}

/// A cylinder along y, its top in the middle.
std::vector<CreaseSample> vault(double radius, std::uint64_t seed, double noise = 0) {
    const auto height = [=](double x) { return std::sqrt(radius * radius - x * x); };
    return relief(24, seed, noise, height, [=](double x) { return -x / height(x); });
}

/// Bent one way along x and the other, less, along y.
std::vector<CreaseSample> saddle(double bend, std::uint64_t seed) {
    support::Random random(seed);
    std::vector<CreaseSample> samples;
    for (int i = 0; i < 48; ++i) {
        const double x = random.uniform() - 0.5;
        const double y = random.uniform() - 0.5;
        const Vec3 normal(bend * x, -0.35 * bend * y, 1);
        samples.push_back({Vec3(x, y, -0.5 * bend * (x * x - 0.35 * y * y)), normal.normalized()});
    }
    return samples;
}

/// The points of each quarter of the square as a set.
struct Quarters {
    std::array<NormalSet, 4> sets{};
    std::vector<CreaseSample> samples;

    explicit Quarters(const std::vector<CreaseSample>& points) {
        std::array<std::vector<Index>, 4> quarter;
        Octree octree;
        for (const CreaseSample& p : points) {
            const std::size_t k = (p.position[0] > 0) + 2 * std::size_t{p.position[1] > 0};
            quarter[k].push_back(static_cast<Index>(octree.positions.size()));
            octree.positions.push_back(p.position);
            octree.normals.push_back(p.normal);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (quarter[k].empty()) continue;
            sets[k] = measure_set(octree, quarter[k], 0, 0.5);
            samples.push_back(crease_sample(sets[k]));
        }
    }
};

bool is_crease(const std::vector<CreaseSample>& samples, BluntCrease& crease,
               std::vector<std::uint8_t>& face) {
    face.assign(samples.size(), 2);
    return find_blunt_crease(samples, 3, face, crease);
}

bool is_crease(const std::vector<CreaseSample>& samples) {
    BluntCrease crease;
    std::vector<std::uint8_t> face;
    return is_crease(samples, crease, face);
}

} // namespace

TEST_CASE("two faces are told apart, each point is on its own, and a valley is no ridge", "[contour]") {
    for (const double angle : {13 * degree, 25 * degree, 40 * degree, -13 * degree, -40 * degree})
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const double at = 0.02 * static_cast<double>(seed) - 0.2;
            INFO("turn " << angle / degree << " degrees at " << at << ", seed " << seed);
            const auto samples = roof(angle, at, seed);
            BluntCrease crease;
            std::vector<std::uint8_t> face;
            REQUIRE(is_crease(samples, crease, face));
            CHECK(crease.is_convex == (angle > 0));
            CHECK(angle_between(crease.normals[0], crease.normals[1]) == Approx(std::abs(angle)));
            const std::uint8_t left = (crease.normals[0][0] < 0) == (angle > 0) ? 0 : 1;
            for (std::size_t i = 0; i < samples.size(); ++i)
                CHECK(face[i] == (samples[i].position[0] < at ? left : 1 - left));
        }
}

TEST_CASE("a crease found among turned normals is the other kind", "[contour]") {
    auto samples = roof(30 * degree, 0, 1);
    for (CreaseSample& s : samples) s.normal *= -1;
    BluntCrease crease;
    std::vector<std::uint8_t> face;
    REQUIRE(is_crease(samples, crease, face));
    CHECK(!crease.is_convex);
    BluntCrease before;
    std::vector<std::uint8_t> face_before;
    REQUIRE(is_crease(roof(30 * degree, 0, 1), before, face_before));
    CHECK(face == face_before);
}

TEST_CASE("sets show a blunt crease as their points do, and none on a round or saddle-shaped surface",
          "[contour]") {
    std::size_t round = 0, tried = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        INFO("seed " << seed);
        CHECK(is_crease(Quarters(roof(30 * degree, 0, seed)).samples));
        CHECK(is_crease(Quarters(roof(-20 * degree, 0, seed)).samples));
        for (const double radius : {0.8, 1.2, 2.0})
            round += is_crease(Quarters(vault(radius, seed)).samples), ++tried;
        for (const double bend : {0.4, 0.7}) {
            round += is_crease(saddle(bend, seed));
            round += is_crease(Quarters(saddle(bend, seed)).samples);
            tried += 2;
        }
    }
    INFO(round << " of " << tried);
    CHECK(round * 50 < tried);
}

TEST_CASE("round, flat and noisy surfaces have no blunt crease", "[contour]") {
    std::size_t found = 0, tried = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        for (const double radius : {0.7, 1.0, 1.5, 2.0, 4.0}) {
            found += is_crease(vault(radius, seed));
            found += is_crease(vault(radius, seed, 3 * degree));
            tried += 2;
        }
        for (const double noise : {0.0, 5 * degree, 15 * degree})
            found += is_crease(roof(0, 0, seed, noise)), ++tried;
    }
    INFO(found << " of " << tried);
    CHECK(found * 100 < tried);
}

TEST_CASE("noise of a few degrees does not hide a crease of thirty", "[contour]") {
    std::size_t found = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
        found += is_crease(roof(30 * degree, 0, seed, 3 * degree));
    CHECK(found > 90);
}

TEST_CASE("edges of prisms that turn by 15 to 60 degrees are sharp", "[contour][accuracy]") {
    for (const int sides : {6, 8, 10, 16, 24}) {
        double bevel = 0, all = 0; // area of facets that lie between two faces
        std::size_t off = 0, count = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            INFO(sides << " sides, seed " << seed);
            const support::Pose pose = support::random_pose(seed);
            const PointCloud cloud =
                support::sample(support::prism(sides, 1, 1).placed(pose), {.points = 12000, .seed = seed});
            const Octree octree = build_octree(cloud);
            const OctreeLevel level = extract_level(octree, 4);
            const DualContour facets = dual_contour(octree, level, build_normal_sets(octree, level));
            CHECK(support::faults(facets.mesh) == "");
            for (std::size_t f = 0; f < facets.mesh.facet_count(); ++f) {
                const Vec3 area = area_vector(facets.mesh, facets.mesh.facet(f));
                const Vec3 n = pose.unrotate(area.normalized());
                const double turn = 2 * std::numbers::pi / sides;
                const double to_face = std::abs(std::remainder(std::atan2(n[1], n[0]), turn));
                all += area.norm();
                if (std::abs(n[2]) < 0.2 && to_face > 0.15 * turn) bevel += area.norm();
            }
            const MeshDistance distance(facets.mesh);
            for (const Vec3& p : octree.positions) off += distance(p) > 0.02 * level.voxel_size;
            count += octree.size();
        }
        INFO(sides << " sides: " << bevel / all << " of the area bevelled, " << off << " of " << count
                   << " points off");
        CHECK(bevel < (sides > 20 ? 0.05 : 0.02) * all);
        CHECK(off * 50 < count);
    }
}
