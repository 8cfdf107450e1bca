#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/random.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <optional>

using namespace hsdm;

namespace {

void check_as_one_piece(const Reconstruction& whole, const Reconstruction& tiles) {
    const PolygonMesh a = to_polygons(whole.mesh), b = to_polygons(tiles.mesh);
    CHECK(a.facet_count() > 100);
    CHECK(support::difference_of_bits(a, b) == "");
    const Report &one = whole.report, &other = tiles.report;
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(one.error.points_to_mesh_mean == other.error.points_to_mesh_mean);
    CHECK(one.input.spacing == other.input.spacing);
    CHECK(one.input.has_normals == other.input.has_normals);
    CHECK(one.grid.voxels == other.grid.voxels);
    CHECK(one.grid.sets == other.grid.sets);
    for (const char* name : {"points_outlying", "normals_near_creases", "normals_missing",
                             "normals_by_volume", "normals_of_layers"})
        CHECK(one.rejected.at(name) == other.rejected.at(name));
    std::vector<Report::Dropped> of_whole = one.dropped;
    std::erase_if(of_whole, [](const auto& dropped) { // what stages find within tiles
        return dropped.what == "facets of splinters" || dropped.what == "points that no neighbour continues";
    });
    REQUIRE(of_whole.size() == other.dropped.size());
    for (std::size_t i = 0; i < of_whole.size(); ++i) CHECK(of_whole[i].where == other.dropped[i].where);
}

TileOptions tiles_with(std::size_t points) {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = points;
    return tiles;
}

/// Flat and round faces, creases, a bore; thin; round all over.
support::Solid solid_for_tiles(int which) {
    if (which == 0) return support::in_general_pose(support::box({1, 0.7, 0.4}) - support::cylinder(0.15, 2));
    if (which == 1) return support::in_general_pose(support::box({1, 0.8, 0.06}));
    if (which == 2) return support::torus(1, 0.35);
    return support::random_solid(static_cast<std::uint64_t>(which));
}

} // namespace

TEST_CASE("tiles of a cloud without normals give the mesh of one piece, bit for bit",
          "[pipeline][tiles][slow]") {
    const int which = GENERATE(0, 1, 2, 6);
    const PointCloud cloud = support::sample(solid_for_tiles(which), {.points = 8000, .normals = false});
    const std::optional<int> depth = which % 2 == 0 ? std::optional<int>(5) : std::nullopt;
    const ReconstructOptions options{.depth = depth};
    const Reconstruction whole = reconstruct(cloud, options);
    const std::size_t points = depth ? 2000 : 6000;
    INFO("solid " << which << ", " << points << " points a tile");
    TileReport how;
    check_as_one_piece(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_with(points), &how));
    CHECK(how.tiles > 1);
}

TEST_CASE("tiles of many cells see as far as a thinly sampled part takes", "[pipeline][tiles][slow]") {
    const auto sampled = [](const support::Solid& solid, std::size_t points) {
        return support::sample(support::in_general_pose(solid), {.points = points, .normals = false});
    };
    PointCloud cloud = sampled(support::box({1, 0.7, 0.4}), 3000);
    for (const Vec3& p : sampled(support::sphere(0.1), 9000).positions)
        cloud.positions.push_back(p + Vec3(0.8, 0.1, 0.2));
    const ReconstructOptions options{.depth = GENERATE(7, 8)};
    INFO("depth " << *options.depth);
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_as_one_piece(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_with(3000), &how));
    CHECK(how.tiles > 1);
}

TEST_CASE("several ranks do a cloud without normals to the bits of one piece", "[pipeline][tiles][slow]") {
    PointCloud cloud = support::sample(solid_for_tiles(0), {.points = 8000, .normals = false});
    int count = 2;
    SECTION("as it is") {
        count = 3;
    }
    SECTION("with outliers within and outside, and duplicates") {
        cloud.positions.push_back({0.03, 0.31, 0.05});
        cloud.positions.push_back({1.2, 0.9, 0.8});
        cloud.positions.push_back({-1.2, 0.6, 0.1});
        for (std::size_t i = 0; i < 100; ++i) cloud.positions.push_back(cloud.positions[37 * i]);
    }
    SECTION("where sheets are read as layers") {
        support::Random random(4);
        for (Vec3& p : cloud.positions) p += Vec3(0, 0, random.uniform() < 0.5 ? 0.0 : 0.012);
    }
    const ReconstructOptions options{.depth = 5, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    check_as_one_piece(whole, support::reconstruct_by_ranks(count, cloud, options, tiles_with(3500)));
}

TEST_CASE("normals are estimated anew in tiles where that is asked for", "[pipeline][tiles][slow]") {
    const PointCloud cloud = support::sample(solid_for_tiles(0), {.points = 12000, .normal_noise = 0.3});
    const ReconstructOptions options{.depth = 5, .normals = NormalSource::estimate};
    check_as_one_piece(reconstruct(cloud, options),
                       reconstruct_in_tiles(view_of(cloud), options, tiles_with(8000)));
}

TEST_CASE("what tiles cannot tell of a cloud without normals is refused", "[pipeline][tiles]") {
    const auto refusal = [](const PointCloud& cloud, const TileOptions& tiles) -> std::string {
        try {
            reconstruct_in_tiles(view_of(cloud), {.depth = 5}, tiles);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    PointCloud cloud = support::sample(support::sphere(1), {.points = 5000, .normals = false});
    SECTION("too little memory for the sides") {
        TileOptions small = tiles_with(3000);
        small.memory = 1000;
        CHECK(refusal(cloud, small).find("--memory") != std::string::npos);
    }
    SECTION("none that are given") {
        CHECK_THROWS_AS(
            reconstruct_in_tiles(view_of(cloud), {.normals = NormalSource::given}, tiles_with(3000)), Error);
    }
}
