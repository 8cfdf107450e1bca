#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace hsdm;
using support::faults;

namespace {

PointCloud scan(const support::Solid& solid, std::size_t points, std::uint64_t seed = 1) {
    return support::sample(solid, {.points = points, .seed = seed, .normals = false});
}

ReconstructOptions at_depth(int depth) {
    const ReconstructOptions options{.depth = depth, .method = Method::basic};
    return options;
}

/// A square in the plane z = 2, its points on a jittered grid.
PointCloud flat_square(int side) {
    support::Random random(9);
    PointCloud cloud;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            cloud.positions.emplace_back(i + random.uniform(0, 0.5), k + random.uniform(0, 0.5), 2);
    return cloud;
}

} // namespace

TEST_CASE("well-sampled solids come out closed, manifold, outward, of the right genus, near the surface",
          "[pipeline]") {
    struct Example {
        const char* name;
        support::Solid solid;
        std::size_t points;
        int depth;
        long genus;
    };
    support::Random random(11);
    const std::vector<Example> examples = {
        {"sphere", support::sphere(1), 20000, 4, 0},
        {"torus", support::torus(1, 0.4).placed(support::random_pose(random)), 30000, 5, 1},
        {"box", support::box(Vec3(1, 1, 1)), 20000, 4, 0},
        {"mechanical part", support::mechanical_part(), 60000, 5, 3},
    };
    for (const Example& example : examples) {
        INFO(example.name);
        const PointCloud cloud = scan(example.solid, example.points);
        const Reconstruction result = reconstruct(cloud, at_depth(example.depth));
        const PolygonMesh mesh = to_polygons(result.mesh);
        CHECK(faults(mesh) == "");
        CHECK(result.report.mesh.closed);
        CHECK(result.report.mesh.components == 1);
        CHECK(result.report.mesh.genus == example.genus);
        CHECK(support::farthest_vertex(mesh, example.solid) < result.report.grid.voxel_size);
        CHECK(result.report.error.points_to_mesh_max < result.report.grid.voxel_size);
    }
}

TEST_CASE("random solids give manifold meshes whatever holes they have", "[pipeline][slow]") {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        INFO("seed " << seed);
        const Reconstruction result =
            reconstruct(scan(support::random_solid(seed), 15000, seed), at_depth(5));
        CHECK(faults(to_polygons(result.mesh)) == "");
        CHECK(result.report.rejected.at("to_mesh") == 0);
    }
}

TEST_CASE("the report agrees with the mesh", "[pipeline]") {
    const Reconstruction result = reconstruct(scan(support::sphere(1), 5000), at_depth(4));
    const Report::Mesh& counts = result.report.mesh;
    CHECK(counts.vertices == result.mesh.n_vertices());
    CHECK(counts.edges == result.mesh.n_edges());
    CHECK(counts.faces == result.mesh.n_faces());
    CHECK(counts.faces == counts.triangles + counts.quads + counts.larger);
    CHECK(counts.euler == 2);
    CHECK(result.report.input.points == 5000);
    CHECK(result.report.grid.leaves_per_level.back() == result.report.grid.voxels);
    CHECK(result.report.features.smooth_vertices + result.report.features.edge_vertices
              + result.report.features.corner_vertices
          == counts.vertices);
    CHECK(result.report.error.normalised_max
          == Approx(result.report.error.points_to_mesh_max / result.report.input.bbox.diagonal()));
}

TEST_CASE("what nobody asks for is left out and changes no facet", "[pipeline]") {
    const PointCloud cloud = scan(support::mechanical_part(), 10000);
    ReconstructOptions all, bare;
    bare.classify = bare.measure = false;
    for (const bool bounded : {false, true}) {
        if (bounded) all.max_error = bare.max_error = MaxError{0.005, true};
        const Reconstruction full = reconstruct(cloud, all), facets = reconstruct(cloud, bare);
        const PolygonMesh expected = to_polygons(full.mesh), mesh = to_polygons(facets.mesh);
        CHECK((mesh.positions == expected.positions));
        CHECK((mesh.corners == expected.corners));
        CHECK((mesh.first == expected.first));
        CHECK(full.report.features.sharp_edges > 0);
        CHECK(full.report.error.points_to_mesh_max > 0);
        CHECK(full.report.mesh.faces == full.mesh.n_faces());
        CHECK(facets.report.features.sharp_edges == 0);
        CHECK(facets.report.error.points_to_mesh_max == 0);
        CHECK(facets.report.mesh.faces == 0);
        CHECK(facets.report.grid.max_error == full.report.grid.max_error);
    }
}

TEST_CASE("the mesh does not depend on threads or on the order of the points", "[pipeline]") {
    PointCloud cloud = scan(support::mechanical_part(), 20000);
    ReconstructOptions options = at_depth(5);
    options.threads = 1;
    const PolygonMesh one = to_polygons(reconstruct(cloud, options).mesh);
    options.threads = 2;
    const PolygonMesh two = to_polygons(reconstruct(cloud, options).mesh);
    std::shuffle(cloud.positions.begin(), cloud.positions.end(), std::mt19937_64(5));
    const PolygonMesh shuffled = to_polygons(reconstruct(cloud, options).mesh);
    for (const PolygonMesh* other : {&two, &shuffled}) {
        CHECK((other->positions == one.positions));
        CHECK((other->corners == one.corners));
        CHECK((other->first == one.first));
        CHECK((other->normals == one.normals));
    }
}

TEST_CASE("coordinates far from the origin lose nothing", "[pipeline]") {
    const PointCloud near = scan(support::torus(1, 0.4), 20000);
    PointCloud far = near;
    const Vec3 shift(1e7, -2e7, 3e6);
    for (Vec3& p : far.positions) p += shift;
    const Reconstruction a = reconstruct(near, at_depth(4)), b = reconstruct(far, at_depth(4));
    CHECK(faults(to_polygons(b.mesh)) == "");
    CHECK(b.report.mesh.closed == a.report.mesh.closed);
    CHECK(b.report.mesh.genus == a.report.mesh.genus);
    CHECK(b.report.error.points_to_mesh_max == Approx(a.report.error.points_to_mesh_max).epsilon(1e-3));
}

TEST_CASE("points in a plane give a valid open mesh", "[pipeline]") {
    const Reconstruction result = reconstruct(flat_square(60), at_depth(4));
    CHECK(faults(to_polygons(result.mesh)) == "");
    CHECK_FALSE(result.report.mesh.closed);
    CHECK(result.report.mesh.components == 1);
    CHECK(result.report.mesh.genus == 0);
    for (const auto v : result.mesh.vertices()) CHECK(result.mesh.point(v)[2] == Approx(2));
}

TEST_CASE("clouds without a surface in them are refused with advice", "[pipeline]") {
    PointCloud cloud;
    CHECK_THROWS_AS(reconstruct(cloud), Error);
    cloud.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    CHECK_THROWS_WITH(reconstruct(cloud), Catch::Contains("needs 4"));
    cloud.positions.assign(100, Vec3(1e7, 2, 3));
    CHECK_THROWS_WITH(reconstruct(cloud), Catch::Contains("equal"));
    cloud.positions.clear();
    for (int i = 0; i < 100; ++i) cloud.positions.push_back(Vec3(1e6, 0, 5) + Vec3(1, 0.3, -2) * (0.01 * i));
    CHECK_THROWS_WITH(reconstruct(cloud), Catch::Contains("on a line"));
    cloud.positions.assign(9, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    cloud.positions.insert(cloud.positions.end(),
                           {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    CHECK_THROWS_WITH(reconstruct(cloud), Catch::Contains("9 of 13"));
}

TEST_CASE("options out of range are refused at the door, by name", "[pipeline]") {
    const PointCloud cloud = scan(support::sphere(1), 1000);
    const auto refused = [&cloud](const std::string& name, auto change) {
        ReconstructOptions options;
        change(options);
        INFO(name);
        CHECK_THROWS_AS(reconstruct(cloud, options), OptionError);
        CHECK_THROWS_WITH(reconstruct(cloud, options), Catch::Contains(name));
    };
    refused("depth 0", [](auto& o) { o.depth = 0; });
    refused("depth 17", [](auto& o) { o.depth = 17; });
    refused("voxel_size", [](auto& o) { o.voxel_size = 0.0; });
    refused("voxel_size", [](auto& o) { o.voxel_size = 1e-8; });
    refused("voxel_size", [](auto& o) { o.voxel_size = std::numeric_limits<double>::infinity(); });
    refused("at most one", [](auto& o) { o.depth = 4, o.voxel_size = 0.1; });
    refused("crease_angle", [](auto& o) { o.crease_angle = std::numbers::pi; });
    refused("normal_smoothing", [](auto& o) { o.normal_smoothing = -1; });
    refused("threads", [](auto& o) { o.threads = -1; });
    CHECK_THROWS_AS(reconstruct_levels(cloud, 4, 3), OptionError);
    CHECK_THROWS_AS(reconstruct_levels(cloud, 0, 3), OptionError);
}

TEST_CASE("a larger voxel than the cloud still has a cube to lie in", "[pipeline]") {
    const Reconstruction result = reconstruct(scan(support::sphere(1), 5000), {.voxel_size = 0.7});
    CHECK(result.report.grid.voxel_size == Approx(0.7));
    CHECK(faults(to_polygons(result.mesh)) == "");
}

TEST_CASE("the callback sees work go forward and can stop it between phases", "[pipeline]") {
    const PointCloud cloud = scan(support::sphere(1), 3000);
    ReconstructOptions options = at_depth(4);
    double last = 0;
    std::vector<std::string> phases;
    options.progress = [&](const char* phase, double done) {
        CHECK(done >= last);
        CHECK(done <= 1);
        last = done;
        phases.emplace_back(phase);
        return true;
    };
    reconstruct_levels(cloud, 3, 4, [&] {
        ReconstructOptions without_depth = options;
        without_depth.depth.reset();
        return without_depth;
    }());
    for (const char* phase : {"octree", "graph", "facets", "mesh", "features", "error"})
        CHECK(std::find(phases.begin(), phases.end(), phase) != phases.end());
    options.progress = [](const char* phase, double) { return std::string(phase) != "facets"; };
    CHECK_THROWS_AS(reconstruct(cloud, options), Cancelled);
}

TEST_CASE("every level of one octree equals the reconstruction at that depth", "[pipeline][slow]") {
    const PointCloud cloud = scan(support::torus(1, 0.4), 20000);
    for (Method method : {Method::basic, Method::extended}) {
        ReconstructOptions options;
        options.method = method;
        const std::vector<Reconstruction> levels = reconstruct_levels(cloud, 3, 5, options);
        REQUIRE(levels.size() == 3);
        for (int depth = 3; depth <= 5; ++depth) {
            options.depth = depth;
            const PolygonMesh alone = to_polygons(reconstruct(cloud, options).mesh);
            const PolygonMesh level = to_polygons(levels[static_cast<std::size_t>(depth - 3)].mesh);
            CHECK((level.positions == alone.positions));
            CHECK((level.corners == alone.corners));
        }
    }
}

TEST_CASE("holes kept leave the loops that holes closed by default fill", "[pipeline]") {
    const PointCloud cloud = scan(support::mechanical_part(), 6000);
    ReconstructOptions options = at_depth(5);
    options.holes = Holes::keep;
    const std::size_t kept = reconstruct(cloud, options).report.mesh.boundary_edges;
    options.holes = Holes::automatic;
    const std::size_t closed = reconstruct(cloud, options).report.mesh.boundary_edges;
    CHECK(kept > 0);
    CHECK(closed < kept);
}

TEST_CASE("points without normals come out like points with exact ones", "[pipeline]") {
    support::Random random(5);
    const support::Solid block = support::box(Vec3(1, 1, 1)).placed(support::random_pose(random));
    PointCloud cloud = support::sample(block, {.points = 8000});
    ReconstructOptions options;
    options.depth = 4;
    const Reconstruction given = reconstruct(cloud, options);
    CHECK(given.report.options.at("normals") == "given");
    options.normals = NormalSource::estimate;
    const Reconstruction replaced = reconstruct(cloud, options);
    CHECK(replaced.report.options.at("normals") == "estimate");
    cloud.normals.clear();
    options.normals = NormalSource::automatic;
    const Reconstruction estimated = reconstruct(cloud, options);
    CHECK(estimated.report.options.at("normals") == "estimate");
    CHECK(estimated.report.options.at("method") == "extended");
    CHECK(estimated.report.seconds.normals > 0);
    CHECK(to_polygons(estimated.mesh).positions == to_polygons(replaced.mesh).positions);
    CHECK(faults(to_polygons(estimated.mesh)) == "");
    CHECK(estimated.report.mesh.closed);
    CHECK(estimated.report.mesh.genus == 0);
    CHECK(estimated.report.features.corner_vertices == given.report.features.corner_vertices);
    CHECK(support::farthest_vertex(to_polygons(estimated.mesh), block)
          < 0.2 * estimated.report.grid.voxel_size);
}

TEST_CASE("noise of half a voxel leaves the topology of points without normals alone", "[pipeline][slow]") {
    constexpr double voxel = 0.1;
    support::Random random(5);
    const support::Pose pose = support::random_pose(random);
    for (const auto& [solid, points, euler] :
         {std::tuple(support::torus(1, 0.4).placed(pose), 12600u, 0L),
          std::tuple(support::box({1.4, 1.1, 0.8}).placed(pose), 6000u, 2L)})
        for (const double noise : {0.25, 0.5})
            for (const bool choose : {false, true}) {
                INFO("euler " << euler << ", noise of " << noise << " voxels, voxel chosen: " << choose);
                ReconstructOptions options;
                if (!choose) options.voxel_size = voxel;
                const Reconstruction result = reconstruct(
                    support::sample(
                        solid,
                        {.points = points, .seed = 23, .normals = false, .position_noise = noise * voxel}),
                    options);
                CHECK(faults(to_polygons(result.mesh)) == "");
                CHECK(result.report.mesh.closed);
                CHECK(result.report.mesh.components == 1);
                CHECK(result.report.mesh.euler == euler);
            }
}

TEST_CASE("noise of half a voxel leaves the topology of points with given normals alone", "[pipeline]") {
    constexpr double voxel = 0.1, noise = 0.5 * voxel;
    support::Random random(3);
    const support::Solid torus = support::torus(1, 0.4).placed(support::random_pose(random));
    ReconstructOptions options;
    options.voxel_size = voxel;
    for (const std::uint64_t seed : {5u, 6u, 7u}) {
        INFO("seed " << seed);
        const Reconstruction result = reconstruct(
            support::sample(torus, {.points = 12600, .seed = seed, .position_noise = noise}), options);
        const Report& report = result.report;
        CHECK(report.options.at("normals") == "given");
        CHECK(faults(to_polygons(result.mesh)) == "");
        CHECK(report.mesh.closed);
        CHECK(report.mesh.components == 1);
        CHECK(report.mesh.euler == 0);
        CHECK(report.rejected.at("points_moved") > 12000);
        CHECK(report.error.points_to_mesh_mean > 0.6 * noise); // of the points as they were read
        CHECK(support::farthest_vertex(to_polygons(result.mesh), torus) < 0.7 * voxel);
    }
}

TEST_CASE("points with given normals are moved only where voxels are small against their noise",
          "[pipeline]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 10000); // 0.035
    const double noise = 0.8 * spacing;
    const PointCloud cloud =
        support::sample(support::sphere(1), {.points = 10000, .seed = 3, .position_noise = noise});
    for (Reconstruction& level : reconstruct_levels(cloud, 3, 5)) {
        const Report& report = level.report;
        INFO("voxel " << report.grid.voxel_size);
        const bool moved = report.rejected.count("points_moved") > 0;
        if (report.grid.voxel_size > 5 * noise) CHECK(!moved);
        if (report.grid.voxel_size < 2.5 * noise) CHECK(moved);
        CHECK(report.mesh.closed);
        CHECK(report.mesh.euler == 2);
    }
    const PointCloud clean = support::sample(support::sphere(1), {.points = 10000, .seed = 3});
    CHECK(reconstruct(clean).report.rejected.count("points_moved") == 0);
}

TEST_CASE("voxels are three spacings wide, or twice the noise if that is more", "[pipeline][slow]") {
    const double spacing = std::sqrt(4 * std::numbers::pi / 20000);
    const auto report = [&](double noise) {
        return reconstruct(
                   support::sample(support::sphere(1),
                                   {.points = 20000, .normals = false, .position_noise = noise * spacing}))
            .report;
    };
    const Report clean = report(0), noisy = report(3);
    CHECK(clean.grid.voxel_size == Approx(3 * spacing).epsilon(0.02));
    CHECK(clean.options.at("resolution").find("noise") == std::string::npos);
    CHECK(noisy.grid.voxel_size == Approx(6 * spacing).epsilon(0.3));
    CHECK(noisy.options.at("resolution").find("noise") != std::string::npos);
    CHECK(noisy.input.spacing == Approx(spacing).epsilon(0.1));
    CHECK(noisy.mesh.closed);
}

TEST_CASE("voxels are finer where the surface bends within those of three spacings", "[pipeline]") {
    const auto spacings_of = [](std::size_t points, double position_noise) {
        const Report report =
            reconstruct(support::sample(support::torus(1, 0.35),
                                        {.points = points, .position_noise = position_noise}))
                .report;
        CHECK(report.mesh.genus == 1);
        CHECK((report.options.at("resolution").find("bends") != std::string::npos)
              == (report.grid.voxel_size < 2.9 * report.input.spacing));
        return report.grid.voxel_size / report.input.spacing;
    };
    CHECK(spacings_of(6000, 0) == Approx(2.4).epsilon(0.001));
    CHECK(spacings_of(6000, 0.008) == Approx(2.4).epsilon(0.001)); // a sixth of a spacing
    CHECK(spacings_of(40000, 0) == Approx(3).epsilon(0.001));
    CHECK(spacings_of(40000, 0.003) == Approx(3).epsilon(0.001));
}

TEST_CASE("given normals of mixed signs give the mesh of consistent ones, and are counted", "[pipeline]") {
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 8000});
    const ReconstructOptions options{.depth = 4};
    const Reconstruction consistent = reconstruct(cloud, options);
    CHECK(consistent.report.rejected.at("normals_mended") == 0);
    for (std::size_t i = 0; i < cloud.size(); i += 20) cloud.normals[i] = -cloud.normals[i];
    const Reconstruction mended = reconstruct(cloud, options);
    CHECK(mended.report.rejected.at("normals_mended") == 400);
    CHECK(to_polygons(mended.mesh).positions == to_polygons(consistent.mesh).positions);
    CHECK(mended.report.mesh.closed);
}

TEST_CASE("the basic method has no use for estimated normals", "[pipeline]") {
    ReconstructOptions options = at_depth(3);
    CHECK(reconstruct(scan(support::sphere(1), 1000), options).report.options.at("normals") == "none");
    options.normals = NormalSource::estimate;
    CHECK_THROWS_AS(reconstruct(scan(support::sphere(1), 1000), options), OptionError);
}

TEST_CASE("given normals that are not there are refused", "[pipeline]") {
    ReconstructOptions options = at_depth(3);
    options.normals = NormalSource::given;
    CHECK_THROWS_AS(reconstruct(scan(support::sphere(1), 1000), options), Error);
}

TEST_CASE("normals that all point inward give the same solid, facing outward", "[pipeline]") {
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 20000});
    for (Vec3& n : cloud.normals) n = -n;
    const Reconstruction result = reconstruct(cloud, {.depth = 5});
    CHECK(result.report.mesh.closed);
    CHECK(result.report.mesh.genus == 1);
    CHECK(result.report.rejected.at("normals_turned") == cloud.size());
    CHECK(measure_topology(to_polygons(result.mesh)).signed_volume > 0);
}

TEST_CASE("a tenth of stray points changes neither the topology nor the resolution", "[pipeline][slow]") {
    for (const NormalSource normals : {NormalSource::given, NormalSource::estimate}) {
        INFO((normals == NormalSource::given ? "given" : "estimated"));
        support::SampleOptions sampling;
        sampling.points = 12600;
        sampling.seed = 7;
        const ReconstructOptions options{.normals = normals};
        const support::Solid torus = support::torus(1, 0.4);
        const Report clean = reconstruct(support::sample(torus, sampling), options).report;
        sampling.outliers = 0.1;
        const Report spoilt = reconstruct(support::sample(torus, sampling), options).report;
        for (const Report* report : {&clean, &spoilt}) {
            CHECK(report->mesh.closed);
            CHECK(report->mesh.components == 1);
            CHECK(report->mesh.euler == 0);
        }
        CHECK(spoilt.rejected.at("points_outlying") > 600);
        CHECK(clean.rejected.at("points_outlying") == 0);
        CHECK(spoilt.input.spacing == Approx(clean.input.spacing).epsilon(0.15));
    }
}

TEST_CASE("a minimal size of components is checked, and the largest is kept", "[pipeline]") {
    PointCloud two = scan(support::sphere(1), 4000);
    for (const Vec3& p : scan(support::sphere(0.3), 800).positions)
        two.positions.push_back(p + Vec3(2, 0, 0));
    ReconstructOptions options;
    options.voxel_size = 0.12;
    CHECK(reconstruct(two, options).report.mesh.components == 2);
    options.min_component = MinComponent{1, true};
    const Reconstruction one = reconstruct(two, options);
    CHECK(one.report.mesh.components == 1);
    CHECK(one.report.mesh.euler == 2);
    CHECK(one.report.rejected.at("components_small") == 1);
    CHECK(one.mesh.n_vertices() == one.report.mesh.vertices);
    for (const MinComponent wrong : {MinComponent{-1, false}, MinComponent{1.5, true},
                                     MinComponent{std::numeric_limits<double>::quiet_NaN(), false}}) {
        options.min_component = wrong;
        CHECK_THROWS_AS(reconstruct(two, options), OptionError);
    }
}

TEST_CASE("a bound is kept for the points of components that are then dropped", "[pipeline]") {
    PointCloud two = scan(support::sphere(1), 4000);
    for (const Vec3& p : scan(support::sphere(0.3), 800).positions)
        two.positions.push_back(p + Vec3(2, 0, 0));
    ReconstructOptions options;
    options.max_error = MaxError{0.05};
    const Report both = reconstruct(two, options).report;
    CHECK(both.error.points_to_mesh_max <= 0.05);
    options.min_component = MinComponent{1, true};
    const Report one = reconstruct(two, options).report;
    CHECK(one.mesh.components == 1);
    CHECK(one.rejected.at("components_small") == 1);
    CHECK(one.grid.points_beyond == 0);
    CHECK(one.error.points_to_mesh_max > 0.9); // of what is written: the dropped component's points count
}

namespace {

/// How a cloud with a stray so many extents away differs from the same without.
void check_stray(const ReconstructOptions& options, double away) {
    const Vec3 direction(0.8, -0.6, 0);
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 20000});
    const Report clean = reconstruct(cloud, options).report;
    cloud.positions.push_back(away * 2.8 * direction);
    cloud.normals.emplace_back(0, 0, 1); // such that the far surface is in its plane
    const Reconstruction spoilt = reconstruct(cloud, options);
    CHECK(faults(to_polygons(spoilt.mesh)) == "");
    CHECK(spoilt.report.mesh.closed);
    CHECK(spoilt.report.mesh.components == 1);
    CHECK(spoilt.report.mesh.euler == 0);
    CHECK(spoilt.report.input.points == cloud.size());
    CHECK(spoilt.report.rejected.at("points_outlying") == 1);
    CHECK((spoilt.report.input.bbox.lo - clean.input.bbox.lo).norm() < 1e-9);
    CHECK((spoilt.report.input.bbox.hi - clean.input.bbox.hi).norm() < 1e-9);
    CHECK(spoilt.report.grid.depth == clean.grid.depth);
    CHECK(spoilt.report.grid.voxel_size == Approx(clean.grid.voxel_size).epsilon(1e-6));
    CHECK(spoilt.report.grid.max_error == Approx(clean.grid.max_error).epsilon(1e-6));
    CHECK(spoilt.report.error.normalised_max == Approx(clean.error.normalised_max).epsilon(0.1));
}

} // namespace

TEST_CASE("a far stray changes neither cube nor resolution", "[pipeline]") {
    for (const NormalSource normals : {NormalSource::given, NormalSource::estimate}) {
        INFO((normals == NormalSource::given ? "given" : "estimated"));
        check_stray({.normals = normals}, 1e9);
    }
}

TEST_CASE("a stray however far changes neither cube nor resolution", "[pipeline][slow]") {
    for (const NormalSource normals : {NormalSource::given, NormalSource::estimate})
        for (const double away : {30.0, 1e3, 3e3, 1e5, 1e9, 1e15, 1e200}) {
            INFO((normals == NormalSource::given ? "given" : "estimated") << ", " << away << " extents");
            check_stray({.normals = normals}, away);
        }
}

TEST_CASE("a far stray has no part in any resolution that is asked for", "[pipeline][slow]") {
    for (const double away : {1e3, 1e5}) {
        INFO(away << " extents");
        ReconstructOptions by_depth, by_voxel, by_error;
        by_depth.depth = 5;
        check_stray(by_depth, away);
        by_voxel.voxel_size = 0.09;
        by_voxel.normals = NormalSource::estimate;
        check_stray(by_voxel, away);
        by_error.max_error = MaxError{0.01, true};
        check_stray(by_error, away);
    }
}

TEST_CASE("a voxel that is chosen gives the mesh that asking for it gives", "[pipeline]") {
    const PointCloud cloud = support::sample(support::box({1.4, 1.1, 0.8}), {.points = 6000, .seed = 4});
    for (const bool merge_layers : {false, true}) {
        INFO("layers merged: " << merge_layers);
        ReconstructOptions options{.merge_layers = merge_layers};
        const Reconstruction chosen = reconstruct(cloud, options);
        options.voxel_size = chosen.report.grid.voxel_size;
        const Reconstruction asked = reconstruct(cloud, options);
        CHECK(asked.report.grid.sets == chosen.report.grid.sets);
        CHECK(mesh_digest(to_polygons(asked.mesh)) == mesh_digest(to_polygons(chosen.mesh)));
    }
}
