#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/adaptive_grid.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

TEST_CASE("a bound broken without being announced is an error", "[pipeline]") {
    Report report;
    report.error.points_to_mesh_max = 2;
    CHECK_NOTHROW(check_error_kept(report)); // no bound
    report.grid.max_error = 2;
    CHECK_NOTHROW(check_error_kept(report));
    report.error.points_to_mesh_max = 2 * (1 + 1e-12);
    CHECK_THROWS_AS(check_error_kept(report), Error);
    report.grid.points_beyond = 1; // announced
    CHECK_NOTHROW(check_error_kept(report));
}

TEST_CASE("attributes on an adaptive grid are means, labels the majority's", "[pipeline]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 20000});
    Scalar height{"height", {}, false}, half{"half", {}, true};
    for (const Vec3& p : cloud.positions) {
        height.values.push_back(p[2]);
        half.values.push_back(p[0] < 0 ? 3 : 8);
        cloud.colors.push_back({static_cast<std::uint8_t>(p[2] > 0 ? 200 : 100), 0, 50, 255});
    }
    cloud.scalars = {height, half};
    ReconstructOptions options;
    options.depth = 4;
    const std::size_t uniform = reconstruct(cloud, options).mesh.n_vertices();
    options.grid = Grid::adaptive;
    const Reconstruction result = reconstruct(cloud, options);
    auto mesh = result.mesh;
    const auto heights = kept_vertex_property<double>(mesh, "height");
    const auto halves = kept_vertex_property<std::int32_t>(mesh, "half");
    const auto red = kept_vertex_property<std::uint8_t>(mesh, "red");
    const auto green = kept_vertex_property<std::uint8_t>(mesh, "green");
    const auto blue = kept_vertex_property<std::uint8_t>(mesh, "blue");
    REQUIRE(mesh.n_vertices() > 0);
    REQUIRE(2 * mesh.n_vertices() < uniform); // a vertex stands for several
    // Of the points of a leaf, two voxels of the finest level wide here, and of those the vertices lie among.
    const double near = 2 * result.report.grid.voxel_size;
    std::size_t mixed = 0;
    for (const auto v : mesh.vertices()) {
        const Vec3 p = mesh.point(v);
        CHECK(std::abs(heights[v] - p[2]) < near);
        if (std::abs(p[0]) > near) CHECK(halves[v] == (p[0] < 0 ? 3 : 8));
        CHECK((halves[v] == 3 || halves[v] == 8));
        if (std::abs(p[2]) > near)
            CHECK(int{red[v]} == (p[2] < 0 ? 100 : 200));
        else
            mixed += int{red[v]} > 100 && int{red[v]} < 200;
        CHECK(int{green[v]} == 0);
        CHECK(int{blue[v]} == 50);
    }
    CHECK(mixed > 0);
}

TEST_CASE("on an adaptive grid the bound is one for noisy points as they were read", "[pipeline][slow]") {
    constexpr double noise = 0.02; // 0.8 spacings: the points are moved
    const PointCloud cloud =
        support::sample(support::sphere(1), {.points = 20000, .normals = false, .position_noise = noise});
    const Reconstruction result = reconstruct(cloud, {.max_error = MaxError{2 * noise}});
    const Report& report = result.report;
    CHECK(report.mesh.closed);
    CHECK(report.mesh.euler == 2);
    const MeshDistance to_mesh(to_polygons(result.mesh));
    std::size_t beyond = 0;
    for (const Vec3& p : cloud.positions) beyond += to_mesh(p) > 2 * noise;
    CHECK(beyond > 400); // of a normal distribution 900
    CHECK(beyond >= report.grid.points_beyond);
    CHECK(beyond <= report.grid.points_beyond + report.rejected.at("points_outlying")
                        + report.rejected.at("points_between_sheets"));
}
