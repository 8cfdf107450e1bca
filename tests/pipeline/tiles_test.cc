#include "hsdm/errors.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/points_in_parts.hh"
#include "hsdm/io/write_om.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "support/check.hh"
#include "support/folder.hh"
#include "support/random.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cstring>
#include <filesystem>

using namespace hsdm;

namespace {

/// A part with flat and round faces, edges, a hole through it; with a border where a face is cut off.
PointCloud scan_for_tiles(bool open) {
    PointCloud cloud =
        support::sample(support::box({1, 0.7, 0.4}) - support::cylinder(0.15, 2), {.points = 40000});
    if (!open) return cloud;
    PointCloud rest;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        if (cloud.positions[i][0] > 0.3) continue;
        rest.positions.push_back(cloud.positions[i]);
        rest.normals.push_back(cloud.normals[i]);
    }
    return rest;
}

/// The same, closed, with an open piece of some 25 facets, beside a part of some 700 at depth 4.
PointCloud part_with_a_flake() {
    PointCloud cloud = scan_for_tiles(false);
    support::Random random(3);
    for (int i = 0; i < 1500; ++i) {
        cloud.positions.push_back({random.uniform(-0.16, 0.16), random.uniform(-0.16, 0.16), 0.4});
        cloud.normals.push_back({0, 0, 1});
    }
    return cloud;
}

void check_same_as_whole(const Reconstruction& whole, const Reconstruction& tiles) {
    const PolygonMesh a = to_polygons(whole.mesh), b = to_polygons(tiles.mesh);
    CHECK(support::difference_of_bits(a, b) == "");
    const Report &one = whole.report, &other = tiles.report;
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(one.error.points_to_mesh_mean == other.error.points_to_mesh_mean);
    CHECK(one.input.spacing == other.input.spacing);
    CHECK(one.rejected.at("points_outlying") == other.rejected.at("points_outlying"));
    CHECK(one.rejected.at("intersections_left") == other.rejected.at("intersections_left"));
    std::vector<Report::Dropped> of_whole = one.dropped;
    std::erase_if(of_whole, [](const auto& dropped) { // what stages find within tiles
        return dropped.what == "facets of splinters" || dropped.what == "points that no neighbour continues";
    });
    REQUIRE(of_whole.size() == other.dropped.size());
    for (std::size_t i = 0; i < of_whole.size(); ++i) {
        CHECK(of_whole[i].count == other.dropped[i].count);
        CHECK(of_whole[i].where == other.dropped[i].where);
    }
    CHECK(one.input.merged_duplicates == other.input.merged_duplicates);
    CHECK(one.grid.voxels == other.grid.voxels);
    CHECK(one.grid.sets == other.grid.sets);
}

TileOptions tiles_of(std::size_t points) {
    TileOptions tiles;
    tiles.memory = std::size_t{1} << 30;
    tiles.most_points = points;
    return tiles;
}

/// What refuses a cloud.
std::string refusal(const PointCloud& cloud, const TileOptions& tiles) {
    try {
        reconstruct_in_tiles(view_of(cloud), {.depth = 6}, tiles);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// .om has the mesh's own properties, in their order.
void write_as_command_does(const std::string& path, PolyMesh mesh, MeshFormat format, bool plain,
                           const WriteOptions& write) {
    PolygonMesh polygons = to_polygons(mesh);
    if (plain) polygons.normals.clear(), polygons.properties.clear(), polygons.sharp_edges.clear();
    if (plain || format != MeshFormat::om) {
        write_mesh(path, polygons, format, write);
        return;
    }
    if (write.recentre) {
        const Vec3 shift = recentring_shift(polygons.positions);
        for (const auto v : mesh.vertices()) mesh.set_point(v, mesh.point(v) - shift);
    }
    write_om(path, mesh);
}

} // namespace

TEST_CASE("tiles give the mesh of the run in one piece, bit for bit", "[pipeline][tiles][slow]") {
    PointCloud cloud = scan_for_tiles(false);
    cloud.positions.push_back({0.03, 0.11, 0.05}); // an outlier
    cloud.normals.push_back({0, 0, 1});
    const ReconstructOptions options{.depth = 6};
    TileReport how;
    check_same_as_whole(reconstruct(cloud, options),
                        reconstruct_in_tiles(view_of(cloud), options, tiles_of(25000), &how));
    CHECK(how.tiles > 1);
}

TEST_CASE("tiles in flat arrays give the same files, whatever the cloud", "[pipeline][tiles][slow]") {
    const bool open = GENERATE(false, true), turned = GENERATE(false, true);
    PointCloud cloud = scan_for_tiles(open);
    if (turned)
        for (Vec3& n : cloud.normals) n = -n;
    if (turned)
        for (Vec3& p : cloud.positions) p += Vec3(4096, -512, 65536);
    const support::Folder folder;
    const ReconstructOptions options{.depth = 6};
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    const PointParts parts = [&](const auto& visit) { visit(view_of(cloud)); };
    TileOptions tiles = tiles_of(25000);
    if (open != turned) tiles.memory = 1; // what nothing reads waits on scratch
    const FlatReconstruction flat = reconstruct_flat_in_tiles(parts, options, tiles, &how);
    CHECK(how.tiles > 1);
    CHECK(how.parks == (open != turned));
    CHECK(flat.report.scratch_bytes >= 48 * cloud.size());
    CHECK(flat.report.scratch_bytes_written >= flat.report.scratch_bytes);
    CHECK(whole.report.scratch_bytes == 0);
    for (const bool plain : {false, true})
        for (const bool ascii : {false, true})
            for (const MeshFormatInfo& format : mesh_formats()) {
                INFO(format.name << (plain ? ", plain" : "") << (ascii ? ", text, less a shift" : ""));
                const WriteOptions write{.ascii = ascii, .unit = LengthUnit::inch, .recentre = ascii};
                write_as_command_does(folder / "a", whole.mesh, format.format, plain, write);
                write_flat(folder / "b", flat, format.format, plain, write);
                CHECK((support::read_file(folder / "a")
                       == support::read_file(folder / "b"))); // not told: megabytes
            }
    CHECK(folder.names() == std::set<std::string>{"a", "b"});
    const Report &one = whole.report, &other = flat.report;
    CHECK(one.mesh.euler == other.mesh.euler);
    CHECK(one.mesh.boundary_loops == other.mesh.boundary_loops);
    CHECK(one.loops.size() == other.loops.size());
    CHECK(one.features.sharp_edges == other.features.sharp_edges);
    CHECK(one.features.corner_vertices == other.features.corner_vertices);
    CHECK(one.error.points_to_mesh_max == other.error.points_to_mesh_max);
    CHECK(one.error.points_to_mesh_rms == other.error.points_to_mesh_rms);
}

TEST_CASE("tiles that are cancelled in any phase leave no scratch", "[pipeline][tiles][slow]") {
    const PointCloud cloud = scan_for_tiles(false);
    const support::Folder folder;
    TileOptions tiles = tiles_of(25000);
    tiles.memory = 1; // so that arrays of the mesh wait on scratch, too
    tiles.scratch = folder.path();
    const PointParts parts = [&](const auto& visit) { visit(view_of(cloud)); };
    for (const std::string phase : {"octree", "survey", "tiles", "whole", "error", "mesh", "features"}) {
        INFO(phase);
        bool reached = false;
        ReconstructOptions options{.depth = 6};
        options.progress = [&](const char* now, double) { return !(reached |= now == phase); };
        CHECK_THROWS_AS(reconstruct_flat_in_tiles(parts, options, tiles), Cancelled);
        CHECK(reached);
        CHECK(folder.names().empty());
    }
}

TEST_CASE("a file that is cut off between the passes over it is no cloud", "[pipeline][tiles]") {
    const support::Folder folder;
    const std::string path = folder / "scan.ply";
    support::write_ply(path, scan_for_tiles(false));
    const PointsInParts points(path, {});
    int passes = 0;
    const PointParts parts = [&](const auto& visit) {
        if (++passes == 2) std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
        points.visit([&](const PointCloud& part) { visit(view_of(part)); });
    };
    CHECK_THROWS_AS(reconstruct_flat_in_tiles(parts, {.depth = 6}, tiles_of(25000)), Error);
    CHECK(passes == 2);
}

TEST_CASE("so do tiles of any size, whatever the cloud", "[pipeline][tiles][slow]") {
    const bool open = GENERATE(false, true);
    PointCloud cloud = scan_for_tiles(open);
    SECTION("as it is") {}
    SECTION("with duplicates and points that are not finite") {
        for (std::size_t i = 0; i < 100; ++i) {
            cloud.positions.push_back(cloud.positions[37 * i]);
            cloud.normals.push_back(cloud.normals[37 * i]);
        }
        cloud.positions[5][1] = std::numeric_limits<double>::quiet_NaN();
    }
    SECTION("with outliers among the points") {
        for (const double at : {-0.31, -0.17, 0.03, 0.21})
            for (int twice = 0; twice < 2; ++twice) {
                cloud.positions.push_back({at, 0.11, 0.05});
                cloud.normals.push_back({0, 0, 1});
            }
    }
    SECTION("with normals that point into the part") {
        for (Vec3& n : cloud.normals) n = -n;
    }
    const ReconstructOptions options{.depth = 6};
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_same_as_whole(whole,
                        reconstruct_in_tiles(view_of(cloud), options, tiles_of(open ? 25000 : 12000), &how));
    CHECK(how.tiles > (open ? 1 : 4));
}

TEST_CASE("outliers that the cube was made for leave tiles another one", "[pipeline][tiles]") {
    PointCloud cloud = scan_for_tiles(false);
    cloud.positions.push_back({0.7, 0.5, 0.4});
    cloud.positions.push_back({-0.2, 0.6, 0.1});
    cloud.normals.resize(cloud.positions.size(), {0, 0, 1});
    const ReconstructOptions options{.depth = GENERATE(3, 4)};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.rejected.at("points_outlying") == 2);
    TileReport how;
    const Reconstruction tiles = reconstruct_in_tiles(view_of(cloud), options, tiles_of(12000), &how);
    check_same_as_whole(whole, tiles);
    CHECK(tiles.report.input.bbox.hi == whole.report.input.bbox.hi);
    CHECK(tiles.report.error.normalised_max == whole.report.error.normalised_max);
    CHECK((how.tiles > 1) == (*options.depth > 3)); // a cell of eight voxels is not divided
}

TEST_CASE("tiles choose the voxels that one piece chooses", "[pipeline][tiles][slow]") {
    PointCloud cloud = scan_for_tiles(false);
    ReconstructOptions options;
    SECTION("by the spacing") {}
    SECTION("by the spacing without an outlier") {
        cloud.positions.push_back({0.7, 0.5, 0.4});
        cloud.normals.push_back({0, 0, 1});
    }
    SECTION("by the spacing of noisy points") {
        cloud = support::sample(support::sphere(1), {.points = 20000, .position_noise = 0.012});
    }
    SECTION("as the surface bends") {
        cloud = support::sample(support::torus(1, 0.35), {.points = 11000});
    }
    SECTION("as asked") {
        options.voxel_size = 0.037;
    }
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    const Reconstruction tiles = reconstruct_in_tiles(view_of(cloud), options, tiles_of(9000), &how);
    check_same_as_whole(whole, tiles);
    CHECK(how.tiles > 1);
    CHECK(tiles.report.grid.depth == whole.report.grid.depth);
    CHECK(tiles.report.grid.voxel_size == whole.report.grid.voxel_size);
    CHECK(tiles.report.options.at("resolution") == whole.report.options.at("resolution"));
}

TEST_CASE("points that come in many parts are the same cloud", "[pipeline][tiles]") {
    const PointCloud cloud = scan_for_tiles(false);
    const PointParts parts = [&](const auto& visit) {
        for (std::size_t first = 0; first < cloud.size(); first += 7000) {
            PointCloud part;
            for (std::size_t i = first; i < std::min(cloud.size(), first + 7000); ++i) {
                part.positions.push_back(cloud.positions[i]);
                part.normals.push_back(cloud.normals[i]);
            }
            visit(view_of(part));
        }
    };
    const ReconstructOptions options{.depth = 6};
    check_same_as_whole(reconstruct(cloud, options), reconstruct_in_tiles(parts, options, tiles_of(25000)));
}

TEST_CASE("neighbours that know too little around them to agree are made again with more",
          "[pipeline][tiles][slow]") {
    const PointCloud cloud = scan_for_tiles(true);
    const ReconstructOptions options{.depth = 6};
    TileOptions tiles = tiles_of(12000);
    tiles.ghost_voxels = 4;
    TileReport how;
    check_same_as_whole(reconstruct(cloud, options),
                        reconstruct_in_tiles(view_of(cloud), options, tiles, &how));
    CHECK(how.widened > 0);
}

TEST_CASE("what is small beside the largest part is judged by all tiles together", "[pipeline][tiles]") {
    const PointCloud cloud = part_with_a_flake();
    const ReconstructOptions options{.depth = 4};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.mesh.components == 2);
    TileReport how;
    check_same_as_whole(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_of(12000), &how));
    CHECK(how.tiles > 1);
}

TEST_CASE("tiles leave out what is too small to be asked for", "[pipeline][tiles][slow]") {
    const PointCloud cloud = part_with_a_flake();
    const ReconstructOptions options{.depth = 4, .min_component = MinComponent{100}};
    const Reconstruction whole = reconstruct(cloud, options);
    CHECK(whole.report.mesh.components == 1);
    const Reconstruction tiles = reconstruct_in_tiles(view_of(cloud), options, tiles_of(12000));
    check_same_as_whole(whole, tiles);
    CHECK(tiles.report.rejected.at("components_small") == 1);
    CHECK(tiles.report.error.points_to_mesh_max > 0.1); // the points of the flake count
}

TEST_CASE("facets that pass through each other are parted by all tiles together", "[pipeline][tiles][slow]") {
    // A solid of which facets are left that moving vertices does not part.
    const PointCloud cloud = support::sample(support::random_solid(29), {.points = 40000, .seed = 29});
    const ReconstructOptions options{.depth = 6};
    const Reconstruction whole = reconstruct(cloud, options);
    TileReport how;
    check_same_as_whole(whole, reconstruct_in_tiles(view_of(cloud), options, tiles_of(15000), &how));
    CHECK(how.tiles > 1);
}

TEST_CASE("what tiles cannot tell is refused, with the reason", "[pipeline][tiles][slow]") {
    PointCloud cloud = scan_for_tiles(false);
    const TileOptions tiles = tiles_of(25000);
    SECTION("extreme size") {
        for (Vec3& p : cloud.positions) p *= 0x1p40;
        CHECK(refusal(cloud, tiles).find("extreme size") != std::string::npos);
    }
    SECTION("too little memory for the mesh") {
        TileOptions small;
        small.memory = 1000000;
        CHECK(refusal(cloud, small).find("held in memory") != std::string::npos);
    }
    SECTION("no place for scratch") {
        TileOptions lost = tiles;
        lost.scratch = "/no/such/folder";
        CHECK(refusal(cloud, lost).find("/no/such/folder") == 0);
    }
    SECTION("options") {
        CHECK_THROWS_AS(reconstruct_in_tiles(view_of(cloud), {.max_error = MaxError{0.01}}, tiles),
                        OptionError);
        CHECK_THROWS_AS(reconstruct_in_tiles(view_of(cloud), {.depth = 6, .merge_layers = true}, tiles),
                        OptionError);
    }
}

TEST_CASE("points that change between two passes are an error", "[pipeline][tiles]") {
    PointCloud cloud = scan_for_tiles(false), fewer = cloud;
    SECTION("in number") {
        fewer.positions.resize(30000);
        fewer.normals.resize(30000);
    }
    SECTION("in their colours") {
        cloud.colors.resize(cloud.size());
    }
    SECTION("in their scalars") {
        cloud.scalars = {{"height", std::vector<double>(cloud.size()), false}};
    }
    int pass = 0;
    const PointParts parts = [&](const auto& visit) { visit(view_of(pass++ == 0 ? cloud : fewer)); };
    CHECK_THROWS_AS(reconstruct_in_tiles(parts, {.depth = 6}, tiles_of(25000)), Error);
}
