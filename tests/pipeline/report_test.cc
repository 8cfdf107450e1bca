#include "hsdm/io/read_points.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/report.hh"

#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <limits>

using namespace hsdm;

TEST_CASE("the report tells what each of several processes did, and how evenly", "[report]") {
    Report report;
    CHECK_FALSE(nlohmann::json::parse(to_json(report)).contains("ranks"));
    CHECK(imbalance_of(report.ranks) == 1);
    report.ranks = {{100, 2, 1.5, 0.25, 4096, 1 << 20}, {90, 1, 0.5, 1.25, 64, 1 << 21}};
    const auto json = nlohmann::json::parse(to_json(report));
    CHECK(json["ranks"].size() == 2);
    CHECK(json["ranks"][1]
          == nlohmann::json({{"points", 90},
                             {"tiles", 1},
                             {"seconds", 0.5},
                             {"seconds_waited", 1.25},
                             {"bytes_sent", 64},
                             {"peak_memory_bytes", 1 << 21},
                             {"scratch_bytes", 0}}));
    CHECK(json["imbalance"] == 1.5);
}

TEST_CASE("the report holds every key that scripts rely on, numbers plain", "[report]") {
    Report report;
    report.options.emplace("depth", "5");
    report.input.file = "a \"quoted\" name \xff.xyz"; // not UTF-8
    report.input.bbox.add(Vec3(1, 2, 3));
    report.rejected["hit_test"] = 7;
    report.warnings.push_back({"doubtful places", {4, 5, 6}, 9});
    const auto json = nlohmann::json::parse(to_json(report));
    const std::vector<std::pair<const char*, std::vector<const char*>>> expected = {
        {"input",
         {"file", "points", "dropped_nonfinite", "merged_duplicates", "has_normals", "bbox_min", "bbox_max",
          "spacing"}},
        {"grid",
         {"kind", "depth", "voxel_size", "voxels", "leaves_per_level", "sets", "balance_splits", "merged",
          "max_error", "points_beyond"}},
        {"mesh",
         {"vertices", "edges", "faces", "triangles", "quads", "larger", "components", "boundary_loops",
          "boundary_edges", "euler", "genus", "closed"}},
        {"features", {"sharp_edges", "smooth_vertices", "edge_vertices", "corner_vertices"}},
        {"error",
         {"points_to_mesh_max", "points_to_mesh_mean", "points_to_mesh_rms", "normalised_max",
          "mesh_to_surface_max", "mesh_to_surface_mean"}},
        {"seconds",
         {"read", "normals", "octree", "graph", "facets", "mesh", "features", "error", "write", "total"}}};
    for (const auto& [section, keys] : expected)
        for (const char* key : keys) {
            INFO(section << "." << key);
            CHECK(json.at(section).contains(key));
        }
    for (const char* key : {"version", "options", "rejected", "peak_memory_bytes", "threads"})
        CHECK(json.contains(key));
    CHECK(json["input"]["bbox_min"] == nlohmann::json{1, 2, 3});
    CHECK(json["rejected"]["hit_test"] == 7);
    CHECK(json["options"]["depth"] == "5");
    CHECK(json["warnings"]
          == nlohmann::json::array({{{"what", "doubtful places"}, {"where", {4, 5, 6}}, {"how_much", 9}}}));
}

TEST_CASE("a report leaves out what is not finite instead of writing null", "[report]") {
    Report report; // its box is empty: from inf to -inf
    report.error.points_to_mesh_max = std::numeric_limits<double>::quiet_NaN();
    const std::string text = to_json(report);
    CHECK(text.find("null") == std::string::npos);
    const auto json = nlohmann::json::parse(text);
    CHECK(json["warnings"] == nlohmann::json::array()); // there, if there are none
    CHECK_FALSE(json["input"].contains("bbox_min"));
    CHECK_FALSE(json["error"].contains("points_to_mesh_max"));
    CHECK(json["error"]["points_to_mesh_mean"] == 0);
}

TEST_CASE("the report of a file's cloud tells what reading left out and took columns for", "[report]") {
    PointFile file;
    file.cloud = support::sample(support::sphere(1), {.points = 2000});
    file.nonfinite = 7;
    file.withheld = 3;
    file.first_withheld = Vec3(1, 2, 3);
    file.columns = "x,y,z,nx,ny,nz";
    file.cloud.positions.front() = Vec3(std::numeric_limits<double>::infinity(), 0, 0);
    const std::size_t points = file.cloud.size();
    PointFile again = file;
    std::vector<Reconstruction> results = reconstruct_levels(std::move(again), 2, 3);
    results.push_back(reconstruct(std::move(file), {.depth = 3}));
    REQUIRE(results.size() == 3);
    for (const Reconstruction& result : results) {
        const Report& report = result.report;
        CHECK(report.input.points == points - 1);
        CHECK(report.input.dropped_nonfinite == 8);
        CHECK(report.options.at("columns") == "x,y,z,nx,ny,nz");
        REQUIRE_FALSE(report.dropped.empty());
        CHECK(report.dropped[0].what == "points that the file marks as withheld");
        CHECK(report.dropped[0].count == 3);
        CHECK(report.dropped[0].where == Vec3(1, 2, 3));
    }
}
