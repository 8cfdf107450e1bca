#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;

namespace {

PointCloud bored_box() {
    return support::sample(support::box({1, 0.7, 0.4}) - support::cylinder(0.15, 2), {.points = 20000});
}

TileOptions small_tiles() {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = 15000;
    return tiles;
}

void check_same_by_ranks(const Reconstruction& whole, const Reconstruction& by_ranks) {
    const PolygonMesh a = to_polygons(whole.mesh), b = to_polygons(by_ranks.mesh);
    CHECK(a.facet_count() > 0);
    CHECK(support::difference_of_bits(a, b) == "");
    const Report &one = whole.report, &other = by_ranks.report;
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(one.error.points_to_mesh_mean == other.error.points_to_mesh_mean);
    CHECK(one.input.spacing == other.input.spacing);
    CHECK(one.input.merged_duplicates == other.input.merged_duplicates);
    CHECK(one.input.dropped_nonfinite == other.input.dropped_nonfinite);
    CHECK(one.rejected.at("points_outlying") == other.rejected.at("points_outlying"));
    REQUIRE(one.dropped.size() == other.dropped.size());
    for (std::size_t i = 0; i < one.dropped.size(); ++i)
        CHECK(one.dropped[i].where == other.dropped[i].where);
}

/// What each rank throws; the first one's result.
std::vector<std::string> run_on(int count, const PointCloud& cloud, const TileOptions& tiles,
                                std::optional<Reconstruction>& result, TileReport& how,
                                std::optional<int> depth = 6) {
    return support::run_ranks(count, [&](Ranks& ranks) {
        TileReport own;
        Reconstruction made = reconstruct_in_tiles(support::share_of(cloud, ranks),
                                                   {.depth = depth, .threads = 2}, tiles, ranks, &own);
        if (!ranks.is_first()) return;
        result.emplace(std::move(made));
        how = std::move(own);
    });
}

} // namespace

TEST_CASE("several ranks give the mesh of one piece, bit for bit", "[pipeline][tiles][slow]") {
    const int count = GENERATE(2, 3);
    PointCloud cloud = bored_box();
    SECTION("as it is") {}
    SECTION("with an outlier, duplicates and a point that is not finite") {
        cloud.positions.push_back({0.03, 0.11, 0.05});
        cloud.normals.push_back({0, 0, 1});
        for (std::size_t i = 0; i < 100; ++i) {
            cloud.positions.push_back(cloud.positions[37 * i]);
            cloud.normals.push_back(cloud.normals[37 * i]);
        }
        cloud.positions[5][1] = std::numeric_limits<double>::quiet_NaN();
    }
    SECTION("with outliers outside all others") {
        cloud.positions.push_back({0.7, 0.5, 0.4});
        cloud.positions.push_back({-0.2, 0.6, 0.1});
        cloud.normals.resize(cloud.positions.size(), {0, 0, 1});
    }
    SECTION("with normals that point into the part") {
        for (Vec3& n : cloud.normals) n = -n;
    }
    const Reconstruction whole = reconstruct(cloud, {.depth = 6});
    std::optional<Reconstruction> result;
    TileReport how;
    for (const std::string& failure : run_on(count, cloud, small_tiles(), result, how))
        CHECK(failure.empty());
    REQUIRE(result);
    check_same_by_ranks(whole, *result);
    std::size_t tiles = 0;
    REQUIRE(how.ranks.size() == static_cast<std::size_t>(count));
    for (const Report::Rank& rank : how.ranks) {
        CHECK(rank.tiles > 0);
        CHECK(rank.points > 0);
        CHECK(rank.seconds > 0);
        CHECK(rank.seconds_waited >= 0);
        CHECK(rank.peak_memory_bytes > 0);
        CHECK(rank.bytes_sent > 0);
        tiles += rank.tiles;
    }
    CHECK(how.tiles == tiles);
    CHECK(imbalance_of(how.ranks) >= 1);
    CHECK(imbalance_of(how.ranks) <= count);
}

TEST_CASE("tiles of two ranks that know too little around them are made again with more",
          "[pipeline][tiles]") {
    const PointCloud cloud = bored_box();
    TileOptions tiles = small_tiles();
    tiles.most_points = 5000;
    tiles.ghost_voxels = 4;
    std::optional<Reconstruction> result;
    TileReport how;
    for (const std::string& failure : run_on(2, cloud, tiles, result, how)) CHECK(failure.empty());
    REQUIRE(result);
    check_same_by_ranks(reconstruct(cloud, {.depth = 6}), *result);
    CHECK(how.widened > 0);
}

TEST_CASE("ranks tell together what is small beside the largest part", "[pipeline][tiles]") {
    const PointCloud cloud = bored_box();
    std::optional<Reconstruction> result;
    TileReport how;
    for (const std::string& failure : run_on(3, cloud, small_tiles(), result, how, 4)) CHECK(failure.empty());
    REQUIRE(result);
    check_same_by_ranks(reconstruct(cloud, {.depth = 4}), *result);
}

TEST_CASE("ranks choose the voxels together", "[pipeline][tiles][slow]") {
    PointCloud cloud;
    SECTION("by the spacing without an outlier") {
        cloud = bored_box();
        cloud.positions.push_back({0.7, 0.5, 0.4});
        cloud.normals.push_back({0, 0, 1});
    }
    SECTION("as the surface bends") {
        cloud = support::sample(support::torus(1, 0.35), {.points = 11000});
    }
    std::optional<Reconstruction> result;
    TileReport how;
    for (const std::string& failure : run_on(3, cloud, small_tiles(), result, how, std::nullopt))
        CHECK(failure.empty());
    REQUIRE(result);
    check_same_by_ranks(reconstruct(cloud, {}), *result);
}

TEST_CASE("ranks measure points that are far from all facets they were sent", "[pipeline][tiles]") {
    PointCloud cloud = bored_box();
    PointCloud small = support::sample(support::box({0.1, 0.1, 0.1}), {.points = 600}); // is dropped
    for (Vec3& p : small.positions) p += Vec3(2, 1.5, 1);
    cloud.positions.insert(cloud.positions.end(), small.positions.begin(), small.positions.end());
    cloud.normals.insert(cloud.normals.end(), small.normals.begin(), small.normals.end());
    const ReconstructOptions options{.depth = 6, .min_component = MinComponent{0.1, true}, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.error.points_to_mesh_max > 1);
    for (const int count : {2, 3}) {
        std::optional<Reconstruction> result;
        for (const std::string& failure : support::run_ranks(count, [&](Ranks& ranks) {
                 Reconstruction made =
                     reconstruct_in_tiles(support::share_of(cloud, ranks), options, small_tiles(), ranks);
                 if (ranks.is_first()) result.emplace(std::move(made));
             }))
            CHECK(failure.empty());
        REQUIRE(result);
        check_same_by_ranks(whole, *result);
        CHECK(whole.report.error.points_to_mesh_rms == result->report.error.points_to_mesh_rms);
    }
}

TEST_CASE("ranks that no cell is left for have nothing to do", "[pipeline][tiles][slow]") {
    PointCloud cloud = bored_box();
    for (std::size_t i = 0; i < 60000; ++i) { // most points in one cell
        cloud.positions.push_back(cloud.positions[0]);
        cloud.normals.push_back(cloud.normals[0]);
    }
    std::optional<Reconstruction> result;
    TileReport how;
    for (const std::string& failure : run_on(5, cloud, small_tiles(), result, how)) CHECK(failure.empty());
    REQUIRE(result);
    check_same_by_ranks(reconstruct(cloud, {.depth = 6}), *result);
    CHECK(std::ranges::count(how.ranks, std::size_t{0}, &Report::Rank::tiles) > 0);
}

TEST_CASE("what one rank cannot read no rank waits for", "[pipeline][tiles]") {
    const PointCloud cloud = bored_box();
    const int failing_pass = GENERATE(1, 2);
    const auto failures = support::run_ranks(3, [&](Ranks& ranks) {
        int pass = 0;
        const PointParts parts = [&](const auto& visit) {
            if (++pass == failing_pass && ranks.rank() == 2) throw Error("scan.ply: cannot be read");
            support::share_of(cloud, ranks)(visit);
        };
        reconstruct_in_tiles(parts, {.depth = 6, .threads = 1}, small_tiles(), ranks);
    });
    CHECK(failures[0] == "scan.ply: cannot be read (rank 2 of 3)");
    CHECK(failures[1] == failures[0]);
    CHECK(failures[2] == "scan.ply: cannot be read");
}

TEST_CASE("ranks refuse what tiles cannot do, all with one reason", "[pipeline][tiles]") {
    PointCloud cloud = bored_box();
    for (Vec3& p : cloud.positions) p *= 0x1p40;
    const auto failures = support::run_ranks(2, [&](Ranks& ranks) {
        reconstruct_in_tiles([&](const auto& visit) { visit(view_of(cloud)); }, {.depth = 6}, small_tiles(),
                             ranks);
    });
    CHECK(failures[0].find("of extreme size") != std::string::npos);
    CHECK(failures[1] == failures[0]);
}
