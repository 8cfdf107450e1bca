// --stage of reconstruct, process and regress, and hsdm stages.

#include "cli/run.hh"
#include "cli/scan.hh"
#include "hsdm/io/read_mesh.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

using namespace hsdm;
using namespace hsdm::test;
using Json = nlohmann::json;

TEST_CASE("stages are listed with their options, built in and loaded ones alike", "[cli]") {
    const Folder folder;
    const std::string modules = with_modules(folder);
    const Json stages = Json::parse(run(folder, "stages --json", modules).out);
    std::set<std::string> names;
    for (const Json& stage : stages) {
        names.insert(stage["name"]);
        CHECK_FALSE(stage["description"].get<std::string>().empty());
        for (const Json& option : stage["options"]) CHECK_FALSE(option["kind"].get<std::string>().empty());
        CHECK(stage.contains("module") == (stage["name"] == "classify-features"));
        if (stage["name"] == "smooth-normals") break; // the one built in comes first
    }
    for (const char* name : {"classify", "smooth-normals"}) CHECK(names.contains(name));
    const std::string text = run(folder, "stages", modules).out;
    CHECK(run(folder, "process --list", modules).out == text);
    for (const char* words :
         {"decimate: ", "ratio=share", "crease-degrees=35 (angle)", "classify-features: "})
        CHECK(text.find(words) != std::string::npos);
}

TEST_CASE("a reconstruction's mesh goes through stages, and the report is of what is written", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult plain =
        run(folder, "reconstruct scan.xyz --depth 4 -o plain.ply --report plain.json");
    REQUIRE(plain.status == 0);
    const CommandResult staged =
        run(folder, "reconstruct scan.xyz --depth 4 --stage decimate:ratio=0.25 --stage quads -o part.ply "
                    "--report part.json");
    INFO(staged.err);
    REQUIRE(staged.status == 0);
    CHECK(staged.out.find("stage     decimate:ratio=0.25: ") != std::string::npos);
    const Json report = Json::parse(read_file(folder / "part.json"));
    const PolygonMesh written = read_mesh(folder / "part.ply");
    CHECK(report["mesh"]["faces"] == written.facet_count());
    CHECK(report["mesh"]["closed"] == true);
    CHECK(report["mesh"]["euler"] == 2);
    CHECK(report["stages"].size() == 2);
    CHECK(report["stages"][0]["call"] == "decimate:ratio=0.25");
    const Json compared = Json::parse(run(folder, "compare scan.xyz part.ply --json").out);
    CHECK(compared["a_to_b"]["max"].get<double>()
          == Approx(report["error"]["points_to_mesh_max"].get<double>()).epsilon(1e-6));
    CHECK(report["error"]["points_to_mesh_mean"].get<double>()
          > Json::parse(read_file(folder / "plain.json"))["error"]["points_to_mesh_mean"].get<double>());

    // What is done in two commands is done in one.
    REQUIRE(run(folder, "process plain.ply --stage decimate:ratio=0.25 --stage quads -o again.ply").status
            == 0);
    CHECK(read_mesh(folder / "again.ply").facet_count() == written.facet_count());
    REQUIRE(run(folder, "reconstruct scan.xyz --levels 3:4 --stage triangulate --quiet -o level.ply").status
            == 0);
    for (const char* name : {"level.d3.ply", "level.d4.ply"}) {
        const PolygonMesh level = read_mesh(folder / name);
        CHECK(level.corners.size() == 3 * level.facet_count());
    }
}

TEST_CASE("a stage that is wrong ends the command before anything is read", "[cli]") {
    const Folder folder;
    for (const std::string command :
         {"reconstruct no.xyz -o a.off --stage ", "process no.off -o a.off --stage "}) {
        CHECK(run(folder, command + "polish").status == 1);
        CHECK(run(folder, command + "polish").err.find("built in are classify") != std::string::npos);
        CHECK(run(folder, command + "decimate:ratio=2").status == 2);
        CHECK(run(folder, command + "decimate:faces=2").status == 2);
    }
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    const CommandResult late = run(folder, "reconstruct scan.xyz --depth 3 -o a.off --stage decimate");
    CHECK(late.status == 2);
    CHECK(late.err.find("facets, ratio and max-error") != std::string::npos);
    CHECK_FALSE(exists(folder / "a.off"));
}

namespace {

/// A scan of the unit sphere, each point with its height.
std::string scan_with_heights(std::size_t points = 4000) {
    std::string text = "x,y,z,height\n";
    for (const Vec3& p : sphere_scan(points).positions) {
        char line[120];
        std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g\n", p[0], p[1], p[2], p[2]);
        text += line;
    }
    return text;
}

/// How far the heights of the mesh are from its vertices' own; huge where there are none.
double height_error(const std::string& path) {
    const PolygonMesh mesh = read_mesh(path);
    double worst = 1e9;
    for (const VertexProperty& property : mesh.properties)
        if (property.name == "height") {
            worst = 0;
            for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
                worst = std::max(worst, std::abs(property.values[v] - mesh.positions[v][2]));
        }
    return worst;
}

} // namespace

TEST_CASE("a mesh gets what a scan carries, in every command that runs stages", "[cli]") {
    const Folder folder;
    folder.write("bare.xyz", xyz(sphere_scan()));
    folder.write("scan.csv", scan_with_heights());
    REQUIRE(run(folder, "reconstruct bare.xyz --depth 4 --quiet -o bare.ply").status == 0);
    CHECK(height_error(folder / "bare.ply") == 1e9);
    const CommandResult processed =
        run(folder, "process bare.ply --stage subdivide --stage transfer:cloud=scan.csv -o part.ply");
    INFO(processed.err);
    REQUIRE(processed.status == 0);
    CHECK(processed.out.find("transfer: 1 property from 4000 points to ") != std::string::npos);
    CHECK(height_error(folder / "part.ply") < 0.1);
    REQUIRE(run(folder, "reconstruct bare.xyz --depth 4 --quiet -o own.ply --stage transfer:cloud=scan.csv")
                .status
            == 0);
    CHECK(height_error(folder / "own.ply") < 0.1);
    // Without a file, from the points that were read.
    REQUIRE(run(folder, "reconstruct scan.csv --levels 3:4 --quiet -o l.ply --stage subdivide --stage "
                        "transfer:neighbors=6")
                .status
            == 0);
    for (const char* name : {"l.d3.ply", "l.d4.ply"}) CHECK(height_error(folder / name) < 0.1);

    // Files of a suite are named from its folder, those of its stages too.
    std::filesystem::create_directory(folder / "suites");
    folder.write("suites/suite.json", R"({"root": "..", "cases": [{"input": "bare.xyz",
        "args": ["--depth", "3", "--stage", "transfer:cloud=scan.csv", "--stage", "triangulate"],
        "expect": {"mesh.quads": 0, "stages.0.call": "transfer:cloud=scan.csv"}}]})");
    const CommandResult suite = run(folder, "regress suites/suite.json");
    INFO(suite.out << suite.err);
    CHECK(suite.status == 0);
}

TEST_CASE("a transfer's cloud that is not there is told before anything is read", "[cli]") {
    const Folder folder;
    for (const std::string command : {"reconstruct no.xyz -o a.ply ", "process no.ply -o a.ply "}) {
        const CommandResult missing = run(folder, command + "--stage transfer:cloud=gone.ply");
        CHECK(missing.status == 1);
        CHECK(missing.err.find("gone.ply: no such file; check the path") != std::string::npos);
        CHECK(run(folder, command + "--stage transfer:cloud=.").err.find("is a directory")
              != std::string::npos);
        CHECK(run(folder, command + "--stage transfer:cloud=").status == 2);
    }
    const CommandResult none = run(folder, "process no.ply -o a.ply --stage transfer");
    CHECK(none.status == 2);
    CHECK(none.err.find("transfer: cloud: not given") != std::string::npos);
    folder.write("scan.csv", scan_with_heights(500));
    const CommandResult same =
        run(folder, "process no.ply -o scan.csv --format ply --stage transfer:cloud=scan.csv");
    CHECK(same.status == 2);
    CHECK(same.err.find("which would be destroyed") != std::string::npos);
    folder.write("bare.xyz", xyz(sphere_scan(500)));
    const CommandResult nothing =
        run(folder, "reconstruct bare.xyz --depth 3 -o a.ply --stage transfer:cloud=bare.xyz");
    CHECK(nothing.status == 1);
    CHECK(nothing.err.find("bare.xyz: its points have nothing of what is asked for") != std::string::npos);
    CHECK_FALSE(exists(folder / "a.ply"));
}

TEST_CASE("a case of a suite goes through stages", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    folder.write("suite.json",
                 R"({"cases": [{"input": "scan.xyz", "args": ["--depth", "3", "--stage", "triangulate"],
        "expect": {"mesh.quads": 0, "mesh.closed": true, "stages.0.call": "triangulate"}}]})");
    const CommandResult result = run(folder, "regress suite.json");
    INFO(result.out << result.err);
    CHECK(result.status == 0);
}
