#include "hsdm/errors.hh"
#include "hsdm/facets/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <limits>

using namespace hsdm;

namespace {

constexpr double not_finite = std::numeric_limits<double>::quiet_NaN();

void check_same(const Reconstruction& a, const Reconstruction& b) {
    const PolygonMesh left = to_polygons(a.mesh), right = to_polygons(b.mesh);
    CHECK(left.facet_count() > 0);
    CHECK(left.positions == right.positions);
    CHECK(left.corners == right.corners);
    CHECK(a.report.options == b.report.options);
    CHECK(a.report.rejected == b.report.rejected);
    CHECK(a.report.input.points == b.report.input.points);
    CHECK(a.report.input.has_normals == b.report.input.has_normals);
    CHECK(a.report.error.points_to_mesh_max == b.report.error.points_to_mesh_max);
    CHECK(a.report.error.points_to_mesh_mean == b.report.error.points_to_mesh_mean);
}

void check_moved_as_kept(const PointCloud& cloud, const ReconstructOptions& options) {
    PointCloud moved = cloud;
    check_same(reconstruct(cloud, options), reconstruct(std::move(moved), options));
}

PointCloud scan(double noise = 0) {
    return support::sample(support::box({1, 0.7, 0.4}), {.points = 8000, .position_noise = noise});
}

} // namespace

TEST_CASE("a cloud that is moved becomes the same mesh as one that is kept", "[reconstruct]") {
    ReconstructOptions options;
    SECTION("by default") {
        check_moved_as_kept(scan(), options);
    }
    SECTION("with colours") {
        PointCloud cloud = scan();
        cloud.colors.assign(cloud.size(), {10, 20, 30, 255});
        check_moved_as_kept(cloud, options);
    }
    SECTION("with points that are not finite") {
        PointCloud cloud = scan();
        cloud.positions[7] = {not_finite, 0, 0};
        check_moved_as_kept(cloud, options);
    }
    SECTION("with a point far away") {
        PointCloud cloud = scan();
        cloud.positions[7] = {1e6, 0, 0};
        check_moved_as_kept(cloud, options);
    }
    SECTION("with noise that is smoothed") {
        const PointCloud cloud = scan(0.02);
        CHECK(reconstruct(cloud, options).report.rejected["points_moved"] > 0);
        check_moved_as_kept(cloud, options);
    }
    SECTION("with normals to be estimated") {
        options.normals = NormalSource::estimate;
        check_moved_as_kept(scan(), options);
    }
    SECTION("on an adaptive grid") {
        options.max_error = MaxError{.value = 0.01};
        check_moved_as_kept(scan(), options);
    }
    SECTION("with the basic method") {
        options.method = Method::basic;
        check_moved_as_kept(scan(), options);
    }
}

TEST_CASE("levels of a cloud that is moved are those of one that is kept", "[reconstruct]") {
    const PointCloud cloud = scan(0.02); // smoothed for the deeper levels only, if at all
    PointCloud moved = cloud;
    const std::vector<Reconstruction> kept = reconstruct_levels(cloud, 3, 5);
    const std::vector<Reconstruction> left = reconstruct_levels(std::move(moved), 3, 5);
    REQUIRE(kept.size() == left.size());
    for (std::size_t i = 0; i < kept.size(); ++i) check_same(kept[i], left[i]);
}

TEST_CASE("a cloud that is moved and holds no surface is refused", "[reconstruct]") {
    CHECK_THROWS_AS(reconstruct(PointCloud()), Error);
    PointCloud cloud = scan();
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (i % 3 != 0) cloud.positions[i][1] = not_finite;
    CHECK_THROWS_WITH(reconstruct(std::move(cloud)), Catch::Contains("5333 of 8000 points"));
}
