#include "hsdm/ReconstructorT.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using support::faults;

namespace {

struct Example {
    const char* name;
    support::Solid solid;
    long genus;
    int carries; ///< the coarsest level whose voxels carry the genus
};

std::vector<Example> examples() {
    support::Random random(21);
    return {{"torus", support::torus(1, 0.4).placed(support::random_pose(random)), 1, 4},
            {"plate", support::box({1, 1, 0.1}).placed(support::random_pose(random)), 0, 4},
            {"mechanical part", support::mechanical_part(support::random_pose(random)), 3, 5}};
}

PointCloud level_scan(const support::Solid& solid, std::size_t points = 20000) {
    return support::sample(solid, {.points = points});
}

} // namespace

TEST_CASE("nested levels on adaptive grids are sound, each that of its depth alone", "[pipeline][slow]") {
    for (const Example& e : examples()) {
        INFO(e.name);
        const PointCloud cloud = level_scan(e.solid);
        ReconstructOptions options;
        const std::vector<Reconstruction> uniform = reconstruct_levels(cloud, 4, 5, options);
        options.grid = Grid::adaptive;
        const std::vector<Reconstruction> levels = reconstruct_levels(cloud, 4, 5, options);
        REQUIRE(levels.size() == 2);
        for (int depth = 4; depth <= 5; ++depth) {
            INFO("depth " << depth);
            const Reconstruction& level = levels[static_cast<std::size_t>(depth - 4)];
            const Report::Mesh& whole = uniform[static_cast<std::size_t>(depth - 4)].report.mesh;
            CHECK(faults(to_polygons(level.mesh)) == "");
            CHECK(level.report.mesh.closed);
            CHECK(level.report.mesh.euler == whole.euler);
            CHECK(level.report.mesh.components == whole.components);
            CHECK(level.report.mesh.faces < whole.faces);
            CHECK(level.report.grid.kind == "adaptive");
            CHECK(level.report.grid.leaves_per_level.size() == static_cast<std::size_t>(depth) + 1);
            if (depth >= e.carries) CHECK(level.report.mesh.genus == e.genus);
            options.depth = depth;
            const PolygonMesh alone = to_polygons(reconstruct(cloud, options).mesh);
            options.depth.reset();
            CHECK((to_polygons(level.mesh).positions == alone.positions));
            CHECK((to_polygons(level.mesh).corners == alone.corners));
        }
    }
}

TEST_CASE("the stage for OpenMesh's meshes gives the mesh of the free function", "[pipeline]") {
    for (const Example& e : examples()) {
        INFO(e.name);
        const PointCloud cloud = level_scan(e.solid, 4000);
        const ReconstructOptions options{.max_error = MaxError{0.01, true}};
        const PolygonMesh expected = to_polygons(reconstruct(cloud, options).mesh);
        PolyMesh mesh;
        mesh.request_vertex_normals();
        for (std::size_t p = 0; p < cloud.size(); ++p)
            mesh.set_normal(mesh.add_vertex(cloud.positions[p]), cloud.normals[p]);
        ReconstructorT<PolyMesh> reconstructor(mesh);
        reconstructor.initialize(options);
        const Report report = reconstructor.reconstruct();
        CHECK(report.grid.kind == "adaptive");
        const PolygonMesh result = to_polygons(mesh);
        CHECK((result.positions == expected.positions));
        CHECK((result.corners == expected.corners));
    }
}

TEST_CASE("a level without a facet says so and leaves the others; if none has any it is an error",
          "[pipeline]") {
    const PointCloud cloud = level_scan(support::sphere(1e12), 4000); // stages work in a unit of their own
    ReconstructOptions options;
    options.method = Method::basic;
    const std::vector<Reconstruction> levels = reconstruct_levels(cloud, 4, 9, options); // 9: a voxel a point
    REQUIRE(levels.size() == 6);
    CHECK(levels[0].report.failure == "");
    CHECK(levels[0].mesh.n_faces() > 500);
    CHECK(levels[5].report.failure.find("no facet") != std::string::npos);
    CHECK(levels[5].report.grid.depth == 9);
    CHECK(levels[5].report.input.points == 4000);
    CHECK(levels[5].report.input.spacing == levels[0].report.input.spacing);
    CHECK(levels[5].mesh.n_vertices() == 0);
    CHECK(to_json(levels[5].report).find("failure") != std::string::npos);
    CHECK(to_json(levels[0].report).find("failure") == std::string::npos);
    CHECK_THROWS_AS(reconstruct_levels(cloud, 9, 10, options), Error);
    options.progress = [](const char* phase, double) { return std::string(phase) != "facets"; };
    CHECK_THROWS_AS(reconstruct_levels(cloud, 4, 5, options), Cancelled);
}
