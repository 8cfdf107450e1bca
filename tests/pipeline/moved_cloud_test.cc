#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <limits>
#include <set>
#include <string>

using namespace hsdm;

namespace {

constexpr double not_finite = std::numeric_limits<double>::quiet_NaN();

/// All of the report but what differs from run to run.
std::string lasting(Report report) {
    report.seconds = {};
    report.peak_memory_bytes = 0;
    return to_json(report);
}

void check_same(const Reconstruction& a, const Reconstruction& b) {
    const PolygonMesh left = to_polygons(a.mesh), right = to_polygons(b.mesh);
    CHECK(left.facet_count() > 0);
    CHECK(!left.properties.empty());
    CHECK(left.positions == right.positions);
    CHECK(left.corners == right.corners);
    REQUIRE(left.properties.size() == right.properties.size());
    for (std::size_t i = 0; i < left.properties.size(); ++i) {
        CHECK(left.properties[i].name == right.properties[i].name);
        CHECK(left.properties[i].values == right.properties[i].values);
    }
    CHECK(lasting(a.report) == lasting(b.report));
}

PointCloud cloud_to_move(double noise = 0) {
    return support::sample(support::box({1, 0.7, 0.4}), {.points = 4000, .position_noise = noise});
}

void check_moved_as_kept(const PointCloud& cloud, const ReconstructOptions& options = {}) {
    PointCloud moved = cloud;
    check_same(reconstruct(cloud, options), reconstruct(std::move(moved), options));
}

} // namespace

TEST_CASE("a cloud that is moved becomes the same mesh as one that is kept", "[pipeline]") {
    ReconstructOptions options;
    SECTION("by default") {
        check_moved_as_kept(cloud_to_move());
    }
    SECTION("with colours and labels") {
        PointCloud cloud = cloud_to_move();
        Scalar height{"height", {}, false}, half{"half", {}, true};
        for (const Vec3& p : cloud.positions) {
            cloud.colors.push_back({static_cast<std::uint8_t>(100 + 80 * p[0]), 20, 30, 255});
            height.values.push_back(p[2]);
            half.values.push_back(p[0] > 0);
        }
        cloud.scalars = {height, half};
        check_moved_as_kept(cloud);
        options.max_error = MaxError{.value = 0.01};
        check_moved_as_kept(cloud, options);
    }
    SECTION("with points that are not finite") {
        PointCloud cloud = cloud_to_move();
        cloud.positions[7] = Vec3(not_finite, 0, 0);
        check_moved_as_kept(cloud);
    }
    SECTION("with a point far away") {
        PointCloud cloud = cloud_to_move();
        cloud.positions[7] = Vec3(1e6, 0, 0);
        check_moved_as_kept(cloud);
    }
    SECTION("with noise that is smoothed") {
        const PointCloud cloud = cloud_to_move(0.02);
        CHECK(reconstruct(cloud).report.rejected["points_moved"] > 0);
        check_moved_as_kept(cloud);
        options.max_error = MaxError{.value = 0.05};
        check_moved_as_kept(cloud, options);
        options.measure = false;
        check_moved_as_kept(cloud, options);
        options.max_error.reset();
        check_moved_as_kept(cloud, options);
    }
    SECTION("with normals to be estimated") {
        options.normals = NormalSource::estimate;
        check_moved_as_kept(cloud_to_move(), options);
        check_moved_as_kept(cloud_to_move(0.02), options);
    }
    SECTION("without small components") {
        options.min_component = MinComponent{.value = 10, .of_largest = false};
        check_moved_as_kept(cloud_to_move(), options);
    }
    SECTION("with the basic method") {
        options.method = Method::basic;
        check_moved_as_kept(cloud_to_move(), options);
    }
}

TEST_CASE("levels of a cloud that is moved are those of one that is kept", "[pipeline]") {
    for (double noise : {0.0, 0.02}) {
        const PointCloud cloud = cloud_to_move(noise);
        PointCloud moved = cloud;
        const std::vector<Reconstruction> kept = reconstruct_levels(cloud, 3, 5);
        const std::vector<Reconstruction> left = reconstruct_levels(std::move(moved), 3, 5);
        REQUIRE(kept.size() == left.size());
        for (std::size_t i = 0; i < kept.size(); ++i) check_same(kept[i], left[i]);
        // Noise is small against the voxels of the first level alone.
        CHECK(kept.front().report.rejected.count("points_moved") == 0);
        CHECK(kept.back().report.rejected.count("points_moved") == (noise > 0));
    }
}

TEST_CASE("a cloud that is moved gives its memory back as soon as nobody asks for it", "[pipeline]") {
    for (double noise : {0.0, 0.02}) {
        PointCloud cloud = cloud_to_move(noise);
        cloud.colors.resize(cloud.size());
        cloud.scalars = {Scalar{"height", std::vector<double>(cloud.size()), false}};
        std::set<std::string> phases;
        ReconstructOptions options;
        options.progress = [&](const std::string& phase, double) {
            if (phase == "facets" || phase == "error") phases.insert(phase);
            if (phase == "facets") {
                CHECK(cloud.normals.capacity() == 0);
                // What is moved is measured where it was.
                CHECK((cloud.positions.capacity() == 0) == (noise == 0));
            }
            if (phase == "error") {
                CHECK(cloud.positions.capacity() == 0);
                CHECK(cloud.colors.capacity() == 0);
                CHECK(cloud.scalars.capacity() == 0);
            }
            return true;
        };
        reconstruct(std::move(cloud), options);
        CHECK(phases.size() == 2);
    }
}

TEST_CASE("an option out of any cloud's range leaves one that is moved as it was", "[pipeline]") {
    PointCloud cloud = cloud_to_move();
    CHECK_THROWS_AS(reconstruct(std::move(cloud), {.depth = 0}), OptionError);
    CHECK_THROWS_AS(reconstruct_levels(std::move(cloud), 4, 3), OptionError);
    CHECK(cloud.positions == cloud_to_move().positions);
    CHECK(cloud.normals == cloud_to_move().normals);
}

TEST_CASE("a cloud that is moved and holds no surface is refused", "[pipeline]") {
    CHECK_THROWS_AS(reconstruct(PointCloud()), Error);
    PointCloud cloud = cloud_to_move();
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (i % 3 != 0) cloud.positions[i][1] = not_finite;
    CHECK_THROWS_WITH(reconstruct(std::move(cloud)), Catch::Contains("2666 of 4000 points"));
}
