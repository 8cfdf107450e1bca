// Clouds in tiles that a surface is missing of, which is completed or closed.
#include "hsdm/errors.hh"
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/folder.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"
#include "support/scanner.hh"
#include "support/written.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

TileOptions tiles_to_complete(std::size_t points, KeptScratch* kept = nullptr) {
    TileOptions tiles;
    tiles.kept = kept;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = points;
    return tiles;
}

/// A ring without the points between two half planes through its axis, each point with its height.
PointCloud broken_ring(bool inward) {
    const PointCloud all = support::sample(support::torus(1, 0.35), {.points = 30000});
    PointCloud cloud;
    Scalar height{"height", {}, false};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3& p = all.positions[i];
        if (std::abs(p[1]) < 0.3 * p[0]) continue;
        cloud.positions.push_back(p);
        cloud.normals.push_back(inward ? -all.normals[i] : all.normals[i]);
        height.values.push_back(p[2]);
    }
    cloud.scalars = {height};
    return cloud;
}

std::size_t loops_completed(const Report& report) {
    return static_cast<std::size_t>(std::ranges::count(report.loops, true, &Report::Loop::completed));
}

void check_same_completed(const Reconstruction& whole, const Reconstruction& tiles) {
    CHECK(support::difference_of_bits(to_polygons(whole.mesh), to_polygons(tiles.mesh)) == "");
    const Report &one = whole.report, &other = tiles.report;
    CHECK(one.rejected.at("intersections_left") == other.rejected.at("intersections_left"));
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(support::difference_of_loops(one, other) == "");
    const auto cavities = [](const Report& report) {
        const auto found = report.rejected.find("facets_of_cavities");
        return found == report.rejected.end() ? 0 : found->second;
    };
    CHECK(cavities(one) == cavities(other));
}

/// Of one process, in flat arrays too, and of three ranks.
Reconstruction check_completed_everywhere(const PointCloud& cloud, const ReconstructOptions& options) {
    Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_same_completed(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_to_complete(9000), &how));
    CHECK(how.tiles > 1);
    const FlatReconstruction flat = reconstruct_flat_in_tiles(
        [&](const auto& visit) { visit(view_of(cloud)); }, options, tiles_to_complete(9000));
    const std::string one = support::ply_of(to_polygons(whole.mesh));
    CHECK(one.find("hsdm_completed") != std::string::npos);
    CHECK((one == support::ply_of(flat))); // not told: megabytes
    check_same_completed(whole, support::reconstruct_by_ranks(3, cloud, options, tiles_to_complete(9000)));
    return whole;
}

} // namespace

TEST_CASE("what is missing of a solid is completed in tiles as in one piece", "[pipeline][tiles][slow]") {
    const bool inward = GENERATE(false, true);
    const Reconstruction whole =
        check_completed_everywhere(broken_ring(inward), {.depth = 5, .holes = Holes::complete, .threads = 2});
    CHECK(whole.report.mesh.closed);
    CHECK(loops_completed(whole.report) == 2);
    CHECK((whole.report.rejected.at("normals_turned") > 0) == inward);
}

TEST_CASE("what scanners looked through stays open space in tiles as in one piece",
          "[pipeline][tiles][slow]") {
    // A cup from two sides, above its rim: its bottom within and below is what nobody saw.
    const support::Solid cup =
        support::cylinder(1, 1.4) - support::cylinder(0.8, 1.4).placed({.shift = Vec3(0, 0, 0.3)});
    PointCloud cloud = support::scan_from({Vec3(4, 0, 2.2), Vec3(-4, 0.5, 2.4)}, cup, 1.3, {.points = 40000});
    const Reconstruction whole =
        check_completed_everywhere(cloud, {.depth = 5, .holes = Holes::complete, .threads = 2});
    CHECK(whole.report.mesh.closed);
    CHECK(whole.report.options.at("sensors") == "2");
    TileOptions small = tiles_to_complete(9000);
    small.memory = std::size_t{65} << 20; // a megabyte beside the program
    CHECK_THROWS_WITH(
        reconstruct_in_tiles(view_of(cloud), {.depth = 5, .holes = Holes::complete, .threads = 2}, small),
        Catch::Contains("MB, which is held in memory"));
}

TEST_CASE("a run that was ended goes on with tiles of each round of a completion",
          "[pipeline][tiles][slow]") {
    const PointCloud cloud = broken_ring(false);
    const ReconstructOptions options{.depth = 5, .holes = Holes::complete, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    const support::Folder folder;
    const auto run = [&] {
        KeptScratch kept(folder / ".", 0, {{"input", "a ring"}});
        TileReport how;
        check_same_completed(
            whole, reconstruct_in_tiles(view_of(cloud), options, tiles_to_complete(9000, &kept), &how));
        return how;
    };
    CHECK(run().kept_tiles == 0);
    const TileReport again = run();
    CHECK(again.tiles > 1);
    CHECK(again.kept_tiles == again.tiles);
}

TEST_CASE("a completion that tears the mesh is done again in tiles as in one piece",
          "[pipeline][tiles][slow]") {
    // A bowl whose outer bottom nobody saw: its first round leaves loops, the second meets what is there.
    const support::Solid bowl = (support::sphere(1) - support::sphere(0.92))
                                - support::box({3, 3, 3}).placed({.shift = Vec3(0, 0, 1.7)});
    const PointCloud all = support::sample(bowl, {.points = 12000});
    PointCloud cloud;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3& p = all.positions[i];
        if (p.norm() > 0.96 && p[2] < -0.3) continue;
        cloud.positions.push_back(p);
        cloud.normals.push_back(all.normals[i]);
    }
    ReconstructOptions options{.holes = Holes::complete, .threads = 2};
    options.voxel_size = 0.1;
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.mesh.euler == 2);
    CHECK(loops_completed(whole.report) == 1); // the better one left none; the first one left two

    // Tiles that are kept are not those of the first round before.
    const support::Folder folder;
    for (const bool kept_all : {false, true}) {
        KeptScratch kept(folder / ".", 0, {{"input", "a bowl"}});
        TileReport how;
        check_same_completed(
            whole, reconstruct_in_tiles(view_of(cloud), options, tiles_to_complete(14000, &kept), &how));
        CHECK(how.tiles > 1);
        CHECK(how.kept_tiles == (kept_all ? how.tiles : 0));
    }
}

TEST_CASE("cavities of a completion go from tiles as from one piece", "[pipeline][tiles][slow]") {
    // A block with a pocket, of which the mouth and the bottom were seen.
    const support::Solid block =
        support::box({2, 2, 2}) - support::box({0.3, 0.3, 0.8}).placed({.shift = {0, 0, 1}});
    const PointCloud all = support::sample(block, {.points = 40000});
    PointCloud cloud;
    Scalar height{"height", {}, false};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3& p = all.positions[i];
        if (std::max(std::abs(p[0]), std::abs(p[1])) < 0.16 && p[2] > 0.68 && p[2] < 0.99) continue;
        cloud.positions.push_back(p);
        cloud.normals.push_back(all.normals[i]);
        height.values.push_back(p[2]);
    }
    cloud.scalars = {height};
    const Reconstruction whole =
        check_completed_everywhere(cloud, {.depth = 5, .holes = Holes::complete, .threads = 2});
    CHECK(whole.report.rejected.at("facets_of_cavities") > 0);
    CHECK(whole.report.mesh.euler == 2);
    CHECK(whole.report.mesh.components == 1);
}

TEST_CASE("tiles that know part of a loop to be closed are made again with more around them",
          "[pipeline][tiles][slow]") {
    const PointCloud all = support::sample(support::sphere(1), {.points = 30000});
    PointCloud cloud;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.positions[i][2] < 0.8) {
            cloud.positions.push_back(all.positions[i]);
            cloud.normals.push_back(all.normals[i]);
        }
    const ReconstructOptions options{.depth = 6, .holes = Holes::close, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.mesh.closed);
    TileReport how;
    check_same_completed(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_to_complete(6000), &how));
    CHECK(how.widened > 0);
}

TEST_CASE("a solid that misses nothing tells that nothing was completed", "[pipeline][tiles]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 20000});
    const bool coloured = GENERATE(false, true);
    if (coloured) cloud.colors.assign(cloud.size(), {10, 20, 30, 255});
    const ReconstructOptions options{.depth = 5, .holes = Holes::complete, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    check_same_completed(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_to_complete(6000)));
    const PolygonMesh mesh = to_polygons(whole.mesh);
    const auto marks = std::ranges::find(mesh.properties, "hsdm_completed", &VertexProperty::name);
    REQUIRE(marks != mesh.properties.end());
    CHECK(std::ranges::count(marks->values, 0) == std::ssize(mesh.positions));
}
