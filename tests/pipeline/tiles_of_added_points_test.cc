// Clouds in tiles to which points are added: between sparse ones, and where a slit was left.
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/folder.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"
#include "support/uneven.hh"
#include "support/written.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

TileOptions added_tiles(std::size_t points, KeptScratch* kept = nullptr) {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = points;
    tiles.kept = kept;
    return tiles;
}

/// Each with a colour and a number of its own.
void paint_by_place(PointCloud& cloud) {
    Scalar height{"height", {}, false};
    for (const Vec3& p : cloud.positions) {
        const auto channel = [](double x) {
            return static_cast<std::uint8_t>(std::lround(128 + 40 * x) & 255);
        };
        cloud.colors.push_back({channel(p[0]), channel(p[1]), channel(p[2]), 255});
        height.values.push_back(p[2]);
    }
    cloud.scalars = {height};
}

/// A third of a sphere thirty times as dense as the rest, which is cut off above `top`.
PointCloud uneven_bowl(double top, bool normals) {
    PointCloud cloud;
    const PointCloud all = support::thinned_on_one_side(
        support::sample(support::sphere(1), {.points = 20000}), Vec3(1, 0.35, 0.2).normalized(), 0.3, 30);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all.positions[i][2] > top) continue;
        cloud.positions.push_back(all.positions[i] + Vec3(3, 0.1, -7));
        if (normals) cloud.normals.push_back(all.normals[i]);
    }
    paint_by_place(cloud);
    return cloud;
}

constexpr double slit_voxel = 0.08;

/// A box without the points of a slit in its top, of three voxels across.
PointCloud slit_box(bool inward) {
    const PointCloud all = support::sample(support::box({2, 1.6, 1.2}), {.points = 18000});
    PointCloud cloud;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3& p = all.positions[i];
        if (all.normals[i][2] > 0.9 && std::abs(p[0]) < 0.9 && std::abs(p[1] - 0.2) < 0.13) continue;
        cloud.positions.push_back(p);
        cloud.normals.push_back(inward ? -all.normals[i] : all.normals[i]);
    }
    paint_by_place(cloud);
    return cloud;
}

const VertexProperty& completed_marks(const PolygonMesh& mesh) {
    const auto found = std::ranges::find(mesh.properties, "hsdm_completed", &VertexProperty::name);
    REQUIRE(found != mesh.properties.end());
    return *found;
}

void check_same_added(const Reconstruction& whole, const Reconstruction& tiles) {
    CHECK(support::difference_of_bits(to_polygons(whole.mesh), to_polygons(tiles.mesh)) == "");
    const Report &one = whole.report, &other = tiles.report;
    CHECK(one.options.at("resolution") == other.options.at("resolution"));
    CHECK(one.grid.voxels == other.grid.voxels);
    CHECK(one.grid.sets == other.grid.sets);
    CHECK(one.rejected.at("normals_turned") == other.rejected.at("normals_turned"));
    CHECK(one.rejected.at("intersections_left") == other.rejected.at("intersections_left"));
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(support::difference_of_loops(one, other) == "");
}

/// Of one process and of three ranks.
Reconstruction check_added_everywhere(const PointCloud& cloud, const ReconstructOptions& options) {
    Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_same_added(whole, reconstruct_in_tiles(view_of(cloud), options, added_tiles(6000), &how));
    CHECK(how.tiles > 1);
    check_same_added(whole, support::reconstruct_by_ranks(3, cloud, options, added_tiles(6000)));
    return whole;
}

void check_added_file(const PointCloud& cloud, const ReconstructOptions& options) {
    const PolygonMesh whole = to_polygons(reconstruct(cloud, options).mesh);
    const FlatReconstruction flat = reconstruct_flat_in_tiles(
        [&](const auto& visit) { visit(view_of(cloud)); }, options, added_tiles(6000));
    const std::string one = support::ply_of(whole);
    CHECK(one.find("hsdm_completed") != std::string::npos);
    CHECK((one == support::ply_of(flat))); // not told: megabytes
}

} // namespace

TEST_CASE("coarser voxels help tiles where points are sparse, as in one piece", "[pipeline][tiles][slow]") {
    const bool normals = GENERATE(true, false);
    const double top = normals ? 2.0 : 0.3;
    const Reconstruction whole = check_added_everywhere(uneven_bowl(top, normals), {.threads = 2});
    CHECK(whole.report.options.at("resolution").find("sparser") != std::string::npos);
    CHECK(whole.report.mesh.boundary_loops == (top > 1 ? 0u : 1u));
    const PolygonMesh mesh = to_polygons(whole.mesh);
    CHECK(std::ranges::count(completed_marks(mesh).values, 0) == std::ssize(mesh.positions));
}

TEST_CASE("slits are closed in tiles as in one piece", "[pipeline][tiles][slow]") {
    ReconstructOptions options{.threads = 2};
    options.voxel_size = slit_voxel;
    const bool inward = GENERATE(false, true);
    const Reconstruction whole = check_added_everywhere(slit_box(inward), options);
    CHECK(whole.report.mesh.closed);
    CHECK((whole.report.rejected.at("normals_turned") > 0) == inward);
    REQUIRE(whole.report.loops.size() == 1);
    CHECK(whole.report.loops[0].completed);
    const PolygonMesh mesh = to_polygons(whole.mesh);
    CHECK(std::ranges::count(completed_marks(mesh).values, 1) > 10);
}

TEST_CASE("points are added in tiles that have nothing beside them", "[pipeline][tiles][slow]") {
    PointCloud cloud = slit_box(false);
    cloud.colors.clear(), cloud.scalars.clear();
    ReconstructOptions options{.threads = 2};
    options.voxel_size = slit_voxel;
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.mesh.closed);
    check_same_added(whole, reconstruct_in_tiles(view_of(cloud), options, added_tiles(9000)));
    options.holes = Holes::keep;
    const Reconstruction open = reconstruct(cloud, options);
    CHECK(open.report.mesh.boundary_loops == 1);
    check_same_added(open, reconstruct_in_tiles(view_of(cloud), options, added_tiles(9000)));
}

TEST_CASE("points that were added are told in files of flat arrays", "[pipeline][tiles]") {
    check_added_file(uneven_bowl(2, true), {.threads = 2});
}

TEST_CASE("so are those across slits", "[pipeline][tiles][slow]") {
    ReconstructOptions options{.threads = 2};
    options.voxel_size = slit_voxel;
    check_added_file(slit_box(false), options);
}

TEST_CASE("a run that was ended goes on with tiles of points that were added", "[pipeline][tiles][slow]") {
    const PointCloud cloud = slit_box(false);
    ReconstructOptions options{.threads = 2};
    options.voxel_size = slit_voxel;
    const Reconstruction whole = reconstruct(cloud, options);
    const support::Folder folder;
    const auto run = [&] {
        KeptScratch kept(folder / ".", 0, {{"input", "a box"}});
        TileReport how;
        check_same_added(whole,
                         reconstruct_in_tiles(view_of(cloud), options, added_tiles(9000, &kept), &how));
        return how;
    };
    run();
    const TileReport again = run();
    CHECK(again.tiles > 1);
    CHECK(again.kept_tiles == again.tiles);
}
