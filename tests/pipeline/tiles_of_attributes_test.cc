// Clouds in tiles whose points have colours, scalars and scanners.
#include "hsdm/errors.hh"
#include "hsdm/io/join_points.hh"
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/folder.hh"
#include "support/random.hh"
#include "support/rank_threads.hh"
#include "support/sample.hh"
#include "support/scanner.hh"
#include "support/written.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

TileOptions tiles_of_colors(std::size_t points = 1600) {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = points;
    return tiles;
}

/// Gives points colours, numbers that are sometimes none, labels, and what meshes do not take over.
void paint(PointCloud& cloud) {
    support::Random random(7);
    Scalar intensity{"intensity", {}, false}, part{"part", {}, true}, level{"hsdm_level", {}, false},
        red{"red", {}, false};
    cloud.colors.clear();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto channel = [&] { return static_cast<std::uint8_t>(random.uniform(0, 256)); };
        cloud.colors.push_back({channel(), channel(), channel(), channel()});
        intensity.values.push_back(i % 9 == 0 ? std::numeric_limits<double>::quiet_NaN() : random.uniform());
        part.values.push_back(std::floor(random.uniform(-2, 3)));
        level.values.push_back(3), red.values.push_back(0.5);
    }
    cloud.scalars = {intensity, part, level, red};
}

PointCloud painted_torus(bool normals, double noise = 0) {
    PointCloud cloud = support::sample(support::torus(1, 0.35),
                                       {.points = 4000, .normals = normals, .position_noise = noise});
    for (std::size_t i = 0; i < 300; ++i) { // equal points, of other colours
        cloud.positions.push_back(cloud.positions[17 * (i / 2)]);
        if (normals) cloud.normals.push_back(cloud.normals[17 * (i / 2)]);
    }
    paint(cloud);
    return cloud;
}

/// Either side may be out.
PointCloud open_sheet(std::size_t points) {
    PointCloud cloud;
    support::Random random(5);
    for (std::size_t i = 0; i < points; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        cloud.positions.emplace_back(x, y, 0.3 * x * x - 0.2 * y * y);
    }
    return cloud;
}

/// Layers that do not register: without the scanners some face the other way.
PointCloud seen_from_three_places(double noise) {
    return support::scan_from_above(support::in_general_pose(support::box({1, 0.8, 0.5})), 1,
                                    {.points = 9000, .positions = 3, .noise = noise, .misalignment = 0.03});
}

std::string option(const Report& report, const char* name) {
    const auto found = report.options.find(name);
    return found == report.options.end() ? "" : found->second;
}

void check_same_values(const Reconstruction& whole, const Reconstruction& tiles) {
    const PolygonMesh one = to_polygons(whole.mesh), other = to_polygons(tiles.mesh);
    CHECK(one.facet_count() > 100);
    CHECK(support::difference_of_bits(one, other) == "");
    for (const char* name : {"normals", "sensors", "left_out"})
        CHECK(option(whole.report, name) == option(tiles.report, name));
    CHECK(whole.report.rejected.at("normals_turned") == tiles.report.rejected.at("normals_turned"));
}

/// Of one process and of three ranks.
Reconstruction check_everywhere(const PointCloud& cloud, const ReconstructOptions& options) {
    Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_same_values(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_of_colors(), &how));
    CHECK(how.tiles > 1);
    check_same_values(whole, support::reconstruct_by_ranks(3, cloud, options, tiles_of_colors()));
    return whole;
}

std::string bytes_written(const support::Folder& folder, const auto& write) {
    write(folder / "mesh");
    return support::read_file(folder / "mesh");
}

} // namespace

TEST_CASE("colours and scalars come to the vertices of tiles as in one piece", "[pipeline][tiles][slow]") {
    ReconstructOptions options{.threads = 2};
    SECTION("of given normals, with outliers outside all others") {
        PointCloud cloud = painted_torus(true);
        for (const Vec3& p : {Vec3(1.7, 1.5, 0.4), Vec3(-1.6, 0.6, 1)}) {
            cloud.positions.push_back(p);
            cloud.normals.push_back({0, 0, 1});
        }
        paint(cloud);
        const Reconstruction whole = check_everywhere(cloud, options);
        std::string names;
        for (const VertexProperty& property : to_polygons(whole.mesh).properties)
            names += property.name + ' ';
        CHECK(names.starts_with("red green blue alpha intensity part hsdm_level "));
    }
    SECTION("of estimated normals") {
        check_everywhere(painted_torus(false), options);
    }
    SECTION("of points that are moved") {
        check_everywhere(painted_torus(false, 0.06), options);
    }
    SECTION("of normals that are mended") {
        PointCloud cloud = painted_torus(true);
        for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.normals[i] = -cloud.normals[i];
        check_everywhere(cloud, options);
    }
}

TEST_CASE("they are in the files of flat arrays, of each format that has them", "[pipeline][tiles]") {
    const PointCloud cloud = painted_torus(true);
    const ReconstructOptions options{.depth = 5, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    TileOptions tiles = tiles_of_colors();
    if (GENERATE(false, true)) tiles.memory = 1; // what nothing reads waits on scratch
    const PointParts parts = [&](const auto& visit) { visit(view_of(cloud)); };
    const FlatReconstruction flat = reconstruct_flat_in_tiles(parts, options, tiles);
    const support::Folder folder;
    const PolygonMesh polygons = to_polygons(whole.mesh);
    for (const MeshFormat format : {MeshFormat::ply, MeshFormat::om, MeshFormat::glb}) {
        INFO(info_of(format).name);
        const std::string one = bytes_written(folder, [&](const std::string& path) {
            if (format == MeshFormat::om)
                write_om(path, whole.mesh);
            else
                write_mesh(path, polygons, format, {});
        });
        const std::string other =
            bytes_written(folder, [&](const std::string& path) { write_flat(path, flat, format, false); });
        CHECK((one == other)); // not told: megabytes
    }
}

TEST_CASE("they stay with their vertices where small parts go", "[pipeline][tiles]") {
    PointCloud cloud = painted_torus(true);
    const PointCloud small = support::sample(support::sphere(0.2), {.points = 1500});
    for (std::size_t i = 0; i < small.size(); ++i) { // within the ring's hole: amid its voxels' codes
        cloud.positions.push_back(small.positions[i]);
        cloud.normals.push_back(small.normals[i]);
    }
    paint(cloud);
    ReconstructOptions options{.depth = 5, .min_component = MinComponent{0.5, true}, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.rejected.at("components_small") == 1);
    const FlatReconstruction flat = reconstruct_flat_in_tiles(
        [&](const auto& visit) { visit(view_of(cloud)); }, options, tiles_of_colors());
    CHECK((support::ply_of(flat) == support::ply_of(to_polygons(whole.mesh))));
}

TEST_CASE("what only some parts of a cloud have is left out, and told", "[pipeline][tiles]") {
    PointCloud all = painted_torus(true);
    const auto half = [&](bool first) {
        PointCloud part;
        for (std::size_t i = first ? 0 : 2000; i < (first ? 2000 : all.size()); ++i) {
            part.positions.push_back(all.positions[i]);
            part.normals.push_back(all.normals[i]);
        }
        return part;
    };
    PointCloud first = half(true), second = half(false);
    const std::vector<double>& values = all.scalars[0].values;
    first.colors.assign(first.size(), {1, 2, 3, 4});
    first.scalars = {{"red", std::vector<double>(first.size(), 5), true},
                     {"intensity", {values.begin(), values.begin() + 2000}, true},
                     {"range", std::vector<double>(first.size(), 6), false}};
    second.scalars = {{"intensity", {values.begin() + 2000, values.end()}, false},
                      {"red", std::vector<double>(second.size(), 7), true}};
    all.colors.clear();
    all.scalars = {{"red", first.scalars[0].values, true}, {"intensity", values, false}};
    all.scalars[0].values.resize(all.size(), 7);
    const PointParts parts = [&](const auto& visit) { visit(view_of(first)), visit(view_of(second)); };
    const ReconstructOptions options{.depth = 5, .threads = 2};
    const Reconstruction tiles = reconstruct_in_tiles(parts, options, tiles_of_colors());
    CHECK(support::difference_of_bits(to_polygons(reconstruct(all, options).mesh), to_polygons(tiles.mesh))
          == "");
    CHECK(tiles.report.options.at("left_out") == "colours, range");
}

TEST_CASE("a run with colours goes on where one was ended", "[pipeline][tiles]") {
    const PointCloud cloud = painted_torus(true);
    const ReconstructOptions options{.depth = 5, .threads = 2};
    const Reconstruction whole = reconstruct(cloud, options);
    const support::Folder folder;
    for (const std::string phase : {"survey", "whole"}) {
        const std::vector<KeptScratch::Trait> job = {{"input", "a torus"}};
        TileOptions tiles = tiles_of_colors();
        TileReport how;
        for (const bool ends : {true, false}) {
            KeptScratch kept(folder / ".", 0, job);
            tiles.kept = &kept;
            ReconstructOptions asked = options;
            asked.progress = [&](const char* now, double) { return !ends || now != phase; };
            if (ends)
                CHECK_THROWS_AS(reconstruct_in_tiles(view_of(cloud), asked, tiles), Cancelled);
            else
                check_same_values(whole, reconstruct_in_tiles(view_of(cloud), asked, tiles, &how));
            if (!ends) kept.remove();
        }
        CHECK(how.went_on);
    }
}

TEST_CASE("points face their own scanners in tiles as in one piece", "[pipeline][tiles][slow]") {
    ReconstructOptions options{.depth = 4, .holes = Holes::keep, .threads = 2};
    PointCloud cloud = seen_from_three_places(0);
    SECTION("of estimated normals, and some of which no scanner is known") {
        for (std::size_t i = 0; i < cloud.size(); i += 5) cloud.sensor_of[i] = i % 2 == 0 ? -1 : 7;
    }
    SECTION("of points that are moved") {
        cloud = seen_from_three_places(0.02);
        options.depth.reset();
    }
    SECTION("of normals that contradict each other, beside a scalar") {
        support::Random random(5);
        cloud = open_sheet(5000);
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const Vec3& p = cloud.positions[i];
            cloud.normals.push_back(Vec3(-0.6 * p[0], 0.4 * p[1], 1).normalized()
                                    * (random.uniform() < 0.5 ? -1 : 1));
            cloud.sensor_of.push_back(static_cast<std::int32_t>(i % 3));
        }
        cloud.sensors = {Vec3(0.3, 0.2, -5), Vec3(2, 0, -4), Vec3(0, 3, -4)};
        cloud.scalars = {{"height", std::vector<double>(cloud.size(), 1), false}};
    }
    const Reconstruction whole = check_everywhere(cloud, options);
    CHECK(option(whole.report, "sensors") == "3");
    CHECK(whole.report.rejected.contains("points_moved") == !options.depth);
    CHECK((cloud.has_normals() ? whole.report.rejected.at("normals_mended") > 0 : true));
}

TEST_CASE("parts that tell of their scanners know what joined scans know", "[pipeline][tiles]") {
    std::vector<PointCloud> scans(3);
    const PointCloud sheet = open_sheet(2700);
    for (std::size_t i = 0; i < sheet.size(); ++i) scans[i / 900].positions.push_back(sheet.positions[i]);
    const Vec3 above(0.3, 0.2, 5), below(0.3, 0.2, -5);
    SECTION("one place") {
        for (PointCloud& scan : scans) scan.sensor = below;
    }
    SECTION("one place, but not of all") {
        scans[0].sensor = scans[1].sensor = below;
    }
    SECTION("one place that is sure, but not of all") {
        scans[0].sensors = {below}, scans[1].sensor = below;
    }
    SECTION("two places") {
        scans[0].sensor = scans[2].sensor = below, scans[1].sensor = above;
    }
    SECTION("two places, numbered one way and the other") {
        scans[0].sensors = {below, above}, scans[1].sensors = {above, below};
        scans[0].sensor_of.assign(900, 0), scans[1].sensor_of.assign(900, 1);
    }
    JoinedPoints joined;
    for (const PointCloud& scan : scans) joined.add({.cloud = scan, .format = "ply"});
    const PointCloud all = std::move(joined).take().cloud;
    const PointParts parts = [&](const auto& visit) {
        for (const PointCloud& scan : scans) visit(view_of(scan));
    };
    const ReconstructOptions options{.depth = 4, .threads = 2};
    check_same_values(reconstruct(all, options), reconstruct_in_tiles(parts, options, tiles_of_colors(900)));
}
