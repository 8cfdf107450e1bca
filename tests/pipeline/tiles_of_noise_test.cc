// Clouds in tiles whose points are moved because of noise, or whose normals are mended.
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/normals/smooth_points.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "hsdm/pipeline/sparse_areas.hh"
#include "support/check.hh"
#include "support/random.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"
#include "support/uneven.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

constexpr std::size_t noisy_points = 8000;

/// A box with a bore, of six squared units.
support::Solid bored_block() {
    return support::in_general_pose(support::box({1.4, 1, 0.8}) - support::cylinder(0.2, 2));
}

/// Noise of so many spacings.
PointCloud noisy_scan(const support::Solid& solid, double area, bool normals, double spacings) {
    const double sigma = spacings * std::sqrt(area / noisy_points);
    return support::sample(solid, {.points = noisy_points, .normals = normals, .position_noise = sigma});
}

TileOptions noisy_tiles() {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = 4000;
    return tiles;
}

void check_noisy_pieces(const Reconstruction& whole, const Reconstruction& tiles) {
    const PolygonMesh a = to_polygons(whole.mesh), b = to_polygons(tiles.mesh);
    CHECK(a.facet_count() > 100);
    CHECK(support::difference_of_bits(a, b) == "");
    const Report &one = whole.report, &other = tiles.report;
    CHECK(one.input.spacing == other.input.spacing);
    // Of points that have been moved: where they were read is rounded once more, and they come in another
    // order.
    const double rounding = one.rejected.contains("points_moved") ? 1e-13 : 0;
    CHECK(one.error.points_to_mesh_max == Approx(other.error.points_to_mesh_max).epsilon(rounding));
    CHECK(one.error.points_to_mesh_mean == Approx(other.error.points_to_mesh_mean).epsilon(rounding));
    for (const auto& [name, count] : other.rejected)
        if (name.starts_with("points") || name.starts_with("normals")) {
            INFO(name);
            CHECK(one.rejected.at(name) == count);
        }
    for (const Report::Dropped& dropped : other.dropped) {
        const auto same = std::ranges::find(one.dropped, dropped.what, &Report::Dropped::what);
        REQUIRE(same != one.dropped.end());
        CHECK(same->count == dropped.count);
        CHECK(same->where == dropped.where);
    }
}

/// In tiles of one process and of three ranks.
Reconstruction check_tiles_and_ranks(const PointCloud& cloud, const ReconstructOptions& options) {
    Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_noisy_pieces(whole, reconstruct_in_tiles(view_of(cloud), options, noisy_tiles(), &how));
    CHECK(how.tiles > 1);
    check_noisy_pieces(whole, support::reconstruct_by_ranks(3, cloud, options, noisy_tiles()));
    return whole;
}

} // namespace

TEST_CASE("noisy points are moved in tiles as in one piece", "[pipeline][tiles][slow]") {
    const bool normals = GENERATE(false, true), chosen = GENERATE(false, true);
    const double spacings = normals == chosen ? 0.5 : 1.2; // which takes a thinned cloud to tell
    INFO(spacings << " spacings of noise" << (normals ? ", normals" : "") << (chosen ? ", any depth" : ""));
    ReconstructOptions options{.threads = 2};
    if (!chosen) options.depth = 5;
    const Reconstruction whole =
        check_tiles_and_ranks(noisy_scan(bored_block(), 6, normals, spacings), options);
    // Beside such voxels less noise is small, unless normals are to be told from it.
    CHECK(whole.report.rejected.contains("points_moved") == (!normals || spacings > 1));
}

TEST_CASE("so are those of a wall as thin as the noise is wide", "[pipeline][tiles][slow]") {
    const double sigma = 1.1 * std::sqrt(2.0 / noisy_points);
    const support::Solid plate = support::in_general_pose(support::box({1, 1, 4 * sigma}));
    const PointCloud cloud = noisy_scan(plate, 2, false, 1.1);
    Octree octree = build_octree(cloud);
    CHECK(smooth_points(octree, 2 * sigma) < 1.2 * sigma); // to two sheets
    check_tiles_and_ranks(cloud, {.depth = 4, .threads = 2});
}

TEST_CASE("normals that scatter or contradict each other are mended in tiles as in one piece",
          "[pipeline][tiles][slow]") {
    const bool chosen = GENERATE(false, true), scatter = GENERATE(false, true), turn = GENERATE(false, true);
    if (!scatter && !turn) return;
    const double position_noise = chosen == (scatter && turn) ? 0 : 0.01;
    PointCloud cloud = support::sample(
        bored_block(),
        {.points = noisy_points, .position_noise = position_noise, .normal_noise = scatter ? 0.35 : 0.0});
    support::Random random(3);
    for (Vec3& n : cloud.normals)
        if (turn && random.uniform() < 0.2) n = -n;
    ReconstructOptions options{.holes = Holes::keep, .threads = 2};
    if (!chosen) options.depth = 4;
    const Reconstruction whole = check_tiles_and_ranks(cloud, options);
    CHECK((whole.report.rejected.at("normals_steadied") > 0) == scatter);
    CHECK((whole.report.rejected.at("normals_mended") > 0) == turn);
}

TEST_CASE("normals face the scanner in tiles as in one piece", "[pipeline][tiles][slow]") {
    PointCloud cloud;
    support::Random random(5);
    for (std::size_t i = 0; i < noisy_points; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        cloud.positions.emplace_back(x, y, 0.3 * x * x - 0.2 * y * y); // either side may be out
    }
    const double side = GENERATE(-5.0, 5.0);
    const Vec3 scanner(0.3, 0.2, side);
    const bool sure = GENERATE(false, true), given = GENERATE(false, true);
    if (sure)
        cloud.sensors = {scanner};
    else
        cloud.sensor = scanner;
    if (given)
        for (const Vec3& p : cloud.positions)
            cloud.normals.push_back(Vec3(-0.6 * p[0], 0.4 * p[1], 1).normalized()
                                    * (random.uniform() < 0.5 ? -1 : 1));
    else
        cloud.positions.emplace_back(0.1, 0.2, 1.5); // an outlier, without which the cube is another one
    const Reconstruction whole = check_tiles_and_ranks(cloud, {.depth = 4, .threads = 2});
    if (!given || sure) {
        const PolygonMesh mesh = to_polygons(whole.mesh);
        std::size_t facing = 0;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f)
            facing += area_vector(mesh, mesh.facet(f))[2] * side > 0;
        CHECK(facing > mesh.facet_count() * 9 / 10);
    }
}

TEST_CASE("noise that is far wider than the voxels asked for is refused in tiles", "[pipeline][tiles]") {
    const PointCloud cloud = noisy_scan(support::sphere(1), 12, false, 1);
    CHECK_THROWS_AS(reconstruct_in_tiles(view_of(cloud), {.depth = 12}, noisy_tiles()), RefusedInTiles);
}

TEST_CASE("voxels of one size are done in tiles where points are far sparser in some places",
          "[pipeline][tiles]") {
    const PointCloud cloud = support::thinned_on_one_side(
        support::sample(support::sphere(1), {.points = 20000}), Vec3(1, 0, 0), 0.3, 30);
    ReconstructOptions options{.holes = Holes::keep};
    options.voxel_size = 0.1;
    check_noisy_pieces(reconstruct(cloud, options),
                       reconstruct_in_tiles(view_of(cloud), options, noisy_tiles()));
}

TEST_CASE("where facets are garbage tiles look for as many handles as one piece does",
          "[pipeline][tiles][slow]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 6000});
    support::Random random(3);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud.positions[i][0] > 0.8)
            cloud.normals[i] =
                Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const ReconstructOptions options{.depth = 4, .normals = NormalSource::given};
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    const Reconstruction tiles = reconstruct_in_tiles(
        view_of(cloud), options, {.memory = std::size_t{1} << 30, .most_points = 2500}, &how);
    CHECK(how.tiles > 1);
    CHECK(support::difference_of_bits(to_polygons(whole.mesh), to_polygons(tiles.mesh)) == "");
}

TEST_CASE("parts of a cloud tell where coarser voxels help as the whole does", "[pipeline][tiles]") {
    const PointCloud cloud = support::thinned_on_one_side(
        support::sample(support::sphere(1), {.points = 20000}), Vec3(1, 0, 0), 0.3, 30);
    const Octree whole = build_octree(cloud);
    for (const int depth : {2, 4, 5, 6, 7}) {
        const int expected = levels_above_sparse(extract_level(whole, depth));
        for (const std::size_t size : {37u, 1000u}) {
            SparseWindows windows(depth);
            std::vector<std::uint8_t> others(whole.size());
            for (std::size_t begin = 0; begin < whole.size(); begin += size) {
                Octree part = whole;
                for (std::size_t i = 0; i < whole.size(); ++i) others[i] = i < begin || i >= begin + size;
                remove_points(part, others);
                windows.add(part);
            }
            CHECK(windows.levels_above() == expected);
        }
        const auto failures = support::run_ranks(3, [&](Ranks& ranks) {
            SparseWindows windows(depth);
            Octree part = whole;
            std::vector<std::uint8_t> others(whole.size());
            for (std::size_t i = 0; i < whole.size(); ++i) // the second has none
                others[i] = (i < whole.size() / 7 ? 0 : 2) != ranks.rank();
            remove_points(part, others);
            windows.add(part);
            windows.join(ranks);
            if (windows.levels_above() != expected) throw Error("other levels by ranks");
        });
        for (const std::string& failure : failures) CHECK(failure == "");
    }
}
