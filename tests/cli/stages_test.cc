// --stage of reconstruct, process and regress, and hsdm stages.

#include "cli/run.hh"
#include "cli/scan.hh"
#include "hsdm/io/read_mesh.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
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
