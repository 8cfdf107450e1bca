// Scans with parts that no scanner saw, as a whole.

#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/scanner.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <utility>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// A scan without the points at which `unseen` holds.
template <class Unseen>
PointCloud partial_scan(const Solid& solid, const SampleOptions& options, const Unseen& unseen) {
    const PointCloud all = sample(solid, options);
    PointCloud cloud;
    for (std::size_t i = 0; i < all.positions.size(); ++i) {
        if (unseen(all.positions[i])) continue;
        cloud.positions.push_back(all.positions[i]);
        if (all.has_normals()) cloud.normals.push_back(all.normals[i]);
    }
    return cloud;
}

const VertexProperty* marks_of(const PolygonMesh& mesh) {
    const auto found = std::ranges::find(mesh.properties, "hsdm_completed", &VertexProperty::name);
    return found == mesh.properties.end() ? nullptr : &*found;
}

struct Completed {
    PolygonMesh mesh;
    Report report;
};

Completed complete(const PointCloud& cloud, double voxel,
                   decltype(ReconstructOptions::progress) progress = {}) {
    ReconstructOptions options;
    options.progress = std::move(progress);
    options.voxel_size = voxel;
    options.holes = Holes::complete;
    const Reconstruction result = reconstruct(cloud, options);
    Completed completed{to_polygons(result.mesh), result.report};
    CHECK(faults(completed.mesh).empty());
    CHECK(completed.report.mesh.closed);
    CHECK(find_self_intersections(completed.mesh).facet_pairs.empty());
    return completed;
}

/// Mean distance of vertices.
double mean_off(const PolygonMesh& mesh, const Solid& solid) {
    double sum = 0;
    for (const Vec3& p : mesh.positions) sum += std::abs(solid.distance(p));
    return sum / static_cast<double>(mesh.vertex_count());
}

} // namespace

TEST_CASE("what is missing of a sphere is completed, marked and listed", "[completion]") {
    for (const bool normals : {true, false}) {
        INFO((normals ? "given" : "estimated") << " normals");
        const PointCloud cloud = partial_scan(sphere(1), {.points = 20000, .normals = normals},
                                              [](const Vec3& p) { return p[2] > 0.85 || p[0] < -0.9; });
        const Completed completed = complete(cloud, 0.08);
        CHECK(completed.report.mesh.euler == 2);
        CHECK(farthest_vertex(completed.mesh, sphere(1)) < 0.06);
        REQUIRE(completed.report.loops.size() == 2);
        for (const Report::Loop& loop : completed.report.loops) {
            CHECK(loop.completed);
            CHECK(loop.edges > 20);
            CHECK(loop.length > 2 * 0.4 * 3.14);
            CHECK(std::abs(loop.where.norm() - 1) < 0.1);
        }
        const VertexProperty* marks = marks_of(completed.mesh);
        REQUIRE(marks != nullptr);
        for (std::size_t v = 0; v < completed.mesh.vertex_count(); ++v) {
            const Vec3& p = completed.mesh.positions[v];
            if (p[2] > 0.95 || p[0] < -0.97) CHECK(marks->values[v] == 1);
            if (p[2] < 0.7 && p[0] > -0.75) CHECK(marks->values[v] == 0);
        }
    }
}

TEST_CASE("a box that stood on a table gets its bottom, with sharp edges", "[completion][accuracy]") {
    const Solid part = in_general_pose(box({1, 1.2, 0.8}));
    const PointCloud cloud = sample(part, {.points = 24000});
    const Vec3 down = cloud.normals[0]; // the face of the first point
    PointCloud seen;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        if ((cloud.normals[i] | down) > 0.99) continue;
        seen.positions.push_back(cloud.positions[i]);
        seen.normals.push_back(cloud.normals[i]);
    }
    REQUIRE(seen.positions.size() < cloud.positions.size());
    const Completed completed = complete(seen, 0.06);
    CHECK(completed.report.mesh.euler == 2);
    CHECK(farthest_vertex(completed.mesh, part) < 0.06);
    CHECK(completed.report.features.sharp_edges > 150);
}

TEST_CASE("a ring of which a piece is missing stays a ring", "[completion][accuracy]") {
    const PointCloud cloud = partial_scan(torus(1, 0.35), {.points = 30000},
                                          [](const Vec3& p) { return p[0] > 0 && std::abs(p[1]) < 0.12; });
    const Completed completed = complete(cloud, 0.06);
    CHECK(completed.report.mesh.euler == 0);
    CHECK(farthest_vertex(completed.mesh, torus(1, 0.35)) < 0.06);
}

TEST_CASE("a closed scan is the same completed or not, but for the marks", "[completion]") {
    const PointCloud cloud = sample(sphere(1), {.points = 8000});
    ReconstructOptions options;
    options.voxel_size = 0.1;
    const PolygonMesh plain = to_polygons(reconstruct(cloud, options).mesh);
    const Completed completed = complete(cloud, 0.1);
    CHECK(completed.mesh.positions == plain.positions);
    CHECK(completed.mesh.corners == plain.corners);
    CHECK(completed.report.loops.empty());
    REQUIRE(marks_of(completed.mesh) != nullptr);
    CHECK(std::ranges::count(marks_of(completed.mesh)->values, 0.0) == std::ssize(completed.mesh.positions));
    CHECK(marks_of(plain) == nullptr);
}

TEST_CASE("completed surfaces have the same bits for any order of points and number of threads",
          "[completion]") {
    PointCloud cloud = partial_scan(in_general_pose(torus(1, 0.4)), {.points = 20000},
                                    [](const Vec3& p) { return p[2] > 0.25; });
    ReconstructOptions options;
    options.voxel_size = 0.09;
    options.holes = Holes::complete;
    const PolygonMesh first = to_polygons(reconstruct(cloud, options).mesh);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    std::reverse(cloud.normals.begin(), cloud.normals.end());
    options.threads = 1;
    const PolygonMesh second = to_polygons(reconstruct(cloud, options).mesh);
    CHECK(first.positions == second.positions);
    CHECK(first.corners == second.corners);
}

TEST_CASE("a no while a surface is completed cancels", "[completion]") {
    const PointCloud cloud =
        partial_scan(sphere(1), {.points = 20000}, [](const Vec3& p) { return p[2] > 0.5; });
    ReconstructOptions options;
    options.holes = Holes::complete;
    options.progress = [](const char* phase, double) { return std::string(phase) != "completion"; };
    CHECK_THROWS_AS(reconstruct(cloud, options), Cancelled);
}

TEST_CASE("confidence tells what was measured, and trimming cuts the rest off", "[completion]") {
    const PointCloud cloud =
        partial_scan(sphere(1), {.points = 40000}, [](const Vec3& p) { return p[2] > 0.6; });
    ReconstructOptions options;
    options.voxel_size = 0.08;
    options.holes = Holes::complete;
    options.confidence = true;
    const PolygonMesh whole = to_polygons(reconstruct(cloud, options).mesh);
    const auto confidence_of = [](const PolygonMesh& mesh) {
        const auto found = std::ranges::find(mesh.properties, "hsdm_confidence", &VertexProperty::name);
        return found == mesh.properties.end() ? std::vector<double>() : found->values;
    };
    const std::vector<double> confidence = confidence_of(whole);
    REQUIRE(confidence.size() == whole.vertex_count());
    double inner = 0, border = 0, inside_count = 0, border_count = 0;
    for (std::size_t v = 0; v < confidence.size(); ++v) {
        const Vec3& p = whole.positions[v];
        INFO("at height " << p[2]);
        CHECK((confidence[v] >= 0 && confidence[v] <= 1));
        if (std::hypot(p[0], p[1]) < 0.6 && p[2] > 0) CHECK(confidence[v] == 0); // of the missing cap
        if (p[2] < 0.5) {
            CHECK(confidence[v] > 0.4);
            inner += confidence[v];
            ++inside_count;
        }
        if (std::abs(p[2] - 0.6) < 0.01 && std::hypot(p[0], p[1]) > 0.79)
            border += confidence[v], ++border_count;
    }
    CHECK(inner / inside_count > 0.85); // counts of random points scatter, and are cut off at 1
    CHECK(std::abs(border / border_count - 0.5) < 0.2);
    options.confidence = false;
    options.trim = 0.3;
    const Reconstruction trimmed = reconstruct(cloud, options);
    CHECK(trimmed.report.mesh.boundary_loops == 1);
    CHECK(trimmed.report.mesh.euler == 1);
    CHECK(trimmed.report.rejected.at("facets_trimmed") > 100);
    CHECK(trimmed.report.warnings.empty());
    const PolygonMesh cut = to_polygons(trimmed.mesh);
    for (const Vec3& p : cut.positions) CHECK(p[2] < 0.7);
    options.voxel_size.reset();
    options.max_error = MaxError{.value = 0.03};
    const Report bounded = reconstruct(cloud, options).report;
    CHECK(bounded.grid.kind == "adaptive");
    CHECK(bounded.mesh.boundary_loops == 1);
    options.trim = 1.5;
    CHECK_THROWS_AS(reconstruct(cloud, options), OptionError);
    options.trim = 0.5;
    options.method = Method::basic;
    CHECK_THROWS_AS(reconstruct(cloud, options), OptionError);
}

TEST_CASE("a mesh of normals that face inward is completed and turned, with the same confidence",
          "[completion][accuracy]") {
    PointCloud cloud = partial_scan(sphere(1), {.points = 12000}, [](const Vec3& p) { return p[2] > 0.9; });
    for (Vec3& n : cloud.normals) n = -n;
    ReconstructOptions options;
    options.voxel_size = 0.1;
    options.holes = Holes::complete;
    options.trim = 0.3;
    const Reconstruction result = reconstruct(cloud, options);
    CHECK(result.report.mesh.boundary_loops == 1);
    options.trim = 0;
    CHECK(reconstruct(cloud, options).report.mesh.closed);
}

TEST_CASE("completed vertices take colours and labels from those around", "[completion]") {
    PointCloud cloud = partial_scan(sphere(1), {.points = 12000}, [](const Vec3& p) { return p[2] > 0.7; });
    Scalar label{"label", {}, true}, height{"height", {}, false};
    for (const Vec3& p : cloud.positions) {
        const bool left = p[0] < 0;
        cloud.colors.push_back({static_cast<std::uint8_t>(left ? 200 : 100), 50, 7, 255});
        label.values.push_back(left ? 3 : 8);
        height.values.push_back(p[2]);
    }
    cloud.scalars = {label, height};
    const Completed completed = complete(cloud, 0.1);
    const VertexProperty* marks = marks_of(completed.mesh);
    REQUIRE(marks != nullptr);
    REQUIRE(std::ranges::count(marks->values, 1.0) > 50);
    std::size_t seen = 0;
    for (const VertexProperty& property : completed.mesh.properties)
        for (std::size_t v = 0; v < property.values.size(); ++v) {
            const double value = property.values[v];
            seen += property.name == "red";
            if (property.name == "red") CHECK((value >= 100 && value <= 200));
            if (property.name == "green") CHECK(value == 50);
            if (property.name == "alpha") CHECK(value == 255);
            if (property.name == "label") CHECK((value == 3 || value == 8));
            if (property.name == "height" && marks->values[v] == 1) CHECK((value > 0.4 && value < 0.71));
        }
    CHECK(seen == completed.mesh.vertex_count());
}

TEST_CASE("a bowl whose outer bottom nobody saw is closed below its inner one", "[completion][slow]") {
    // A flat surface over the outer border passes through the inner bottom.
    const Solid bowl = (sphere(1) - sphere(0.92)) - box({3, 3, 3}).placed(turned({1, 0, 0}, 0, {0, 0, 1.7}));
    const PointCloud cloud = partial_scan(bowl, {.points = 40000, .normals = true},
                                          [](const Vec3& p) { return p.norm() > 0.96 && p[2] < -0.3; });
    double done = 0;
    const Completed completed = complete(cloud, 0.06, [&](const char*, double share) {
        CHECK(share >= done);
        done = share;
        return true;
    });
    CHECK(completed.report.mesh.components == 1);
    CHECK(completed.report.mesh.euler == 2);
}

TEST_CASE("a bore that a scanner looked through stays open, though nobody saw its wall", "[completion]") {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        // A block with a bore along x; behind it a wall, which one of the scanners sees through the bore.
        Random random(seed);
        const double radius = random.uniform(0.33, 0.4), half_pi = 0.5 * std::numbers::pi;
        const Solid block = (box({2.2, 1, 1}) - cylinder(radius, 3).placed(turned({0, 1, 0}, half_pi)))
                                .placed({.shift = {0.5, 0, 0}});
        const Solid scene = block | box({0.2, 1.8, 1.8}).placed({.shift = {-1.1, 0, 0}});
        std::vector<Vec3> places{{30, 0, 0}};
        for (int k = 0; k < 4; ++k)
            places.emplace_back(0.5, 6 * std::cos(1.6 * k + 0.3), 6 * std::sin(1.6 * k + 0.3));
        places.emplace_back(-4, 4, 0);
        places.emplace_back(-4, -4, 0);
        PointCloud cloud = scan_from(places, scene, 1.8, {.points = 100000, .seed = seed});
        const Completed completed = complete(cloud, 0.07);
        CHECK(completed.report.mesh.components == 2);
        CHECK(completed.report.mesh.euler == 2); // 0 of the block, 2 of the wall
    }
}

TEST_CASE("a bore of whose wall the ends alone were seen goes through, however long it is", "[completion]") {
    const double half_pi = 0.5 * std::numbers::pi;
    const Solid block = box({2.4, 1, 1}) - cylinder(0.25, 3).placed(turned({0, 1, 0}, half_pi));
    for (const double strip : {-1.0, 0.18}) { // wide, seen all along
        const PointCloud cloud = partial_scan(block, {.points = 40000, .normals = false}, [&](const Vec3& p) {
            return std::hypot(p[1], p[2]) < 0.3 && std::abs(p[0]) < 0.8
                   && !(p[2] > 0 && std::abs(p[1]) < strip);
        });
        const Completed completed = complete(cloud, 0.06);
        CHECK(completed.report.mesh.components == 1);
        CHECK(completed.report.mesh.euler == 0);
        CHECK(farthest_vertex(completed.mesh, block) < 0.06);
    }
}

TEST_CASE("bores that cross, and one that ends in a slot, go through though their middle was not seen",
          "[completion]") {
    const double half_pi = 0.5 * std::numbers::pi, radius = 0.22;
    const Solid one = cylinder(radius, 4).placed(turned({0, 1, 0}, half_pi)),
                other = cylinder(radius, 4).placed(turned({1, 0, 0}, half_pi)), slot = box({0.4, 4, 1});
    const Solid block = box({2, 2, 1.2});
    struct Case {
        Solid solid, gone;
        long euler;
    };
    for (const Case& c : {Case{block - one - other, one | other, -4},
                          Case{block - one - slot.placed({.shift = {0, 0, 0.5}}), one, -2}}) {
        const PointCloud cloud =
            partial_scan(c.solid, {.points = 60000, .normals = false}, [&](const Vec3& p) {
                return c.gone.distance(p) < 0.01 && std::max(std::abs(p[0]), std::abs(p[1])) < 0.75;
            });
        const Completed completed = complete(cloud, 0.05);
        CHECK(completed.report.mesh.components == 1);
        CHECK(completed.report.mesh.euler == c.euler);
        CHECK(mean_off(completed.mesh, c.solid) < 0.01);
    }
}

TEST_CASE(
    "a wall no thicker than four deviations of the noise comes out as a wall, not as a sheet that is closed "
    "behind",
    "[completion][slow]") {
    for (const std::uint64_t seed : {1u, 2u}) {
        const double sigma = 0.011, wall = 4 * sigma;
        const Solid angle = box({1, 1, 1}) - box({1, 1.2, 1}).placed(turned({0, 0, 1}, 0, {wall, 0, wall}));
        const PointCloud cloud =
            sample(angle, {.points = 30000, .seed = seed, .normals = false, .position_noise = sigma});
        ReconstructOptions options;
        options.holes = Holes::complete;
        const Reconstruction result = reconstruct(cloud, options);
        const PolygonMesh mesh = to_polygons(result.mesh);
        CHECK(faults(mesh).empty());
        CHECK(result.report.mesh.closed);
        CHECK(result.report.mesh.components == 1);
        CHECK(mean_off(mesh, angle) < 0.5 * sigma);
    }
}
