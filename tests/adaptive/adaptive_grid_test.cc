#include "hsdm/adaptive/adaptive_grid.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/vertex_normals.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

TEST_CASE("a bound broken without being announced is an error", "[adaptive]") {
    Report report;
    report.error.points_to_mesh_max = 2;
    CHECK_NOTHROW(check_error_kept(report)); // no bound
    report.grid.max_error = 2;
    CHECK_NOTHROW(check_error_kept(report));
    report.error.points_to_mesh_max = 2.001;
    CHECK_THROWS_AS(check_error_kept(report), Error);
    report.grid.points_beyond = 1; // announced
    CHECK_NOTHROW(check_error_kept(report));
}

TEST_CASE("attributes on an adaptive grid are means, labels the majority's", "[adaptive]") {
    PointCloud cloud = support::sample(support::box({1, 1, 1}), {.points = 20000});
    Scalar height{"height", {}, false}, half{"half", {}, true};
    for (const Vec3& p : cloud.positions) {
        height.values.push_back(p[2]);
        half.values.push_back(p[0] < 0 ? 3 : 8);
        cloud.colors.push_back({static_cast<std::uint8_t>(p[2] > 0 ? 200 : 100), 0, 50, 255});
    }
    cloud.scalars = {height, half};
    ReconstructOptions options;
    options.grid = Grid::adaptive;
    options.depth = 4;
    const Reconstruction result = reconstruct(cloud, options);
    auto mesh = result.mesh;
    const auto heights = kept_vertex_property<double>(mesh, "height");
    const auto halves = kept_vertex_property<std::int32_t>(mesh, "half");
    REQUIRE(mesh.n_vertices() > 0);
    double sum = 0;
    for (const auto v : mesh.vertices()) {
        CHECK((halves[v] == 3 || halves[v] == 8));
        CHECK(std::abs(heights[v]) <= 0.5);
        sum += heights[v];
    }
    CHECK(std::abs(sum) / static_cast<double>(mesh.n_vertices()) < 0.1);
}
