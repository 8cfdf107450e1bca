#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>

using namespace hsdm;
using namespace hsdm::test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("info tells a cloud from a mesh and measures both", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 -o part.ply").status == 0);
    const Json cloud = Json::parse(run(folder, "info scan.xyz --json").out);
    CHECK(cloud["kind"] == "cloud");
    CHECK(cloud["cloud"]["points"] == 4000);
    CHECK(cloud["cloud"]["spacing"].get<double>() == Approx(0.056).epsilon(0.15));
    const Json mesh = Json::parse(run(folder, "info part.ply --json").out);
    CHECK(mesh["kind"] == "mesh");
    CHECK(mesh["mesh"]["closed"] == true);
    CHECK(mesh["mesh"]["manifold"] == true);
    CHECK(mesh["mesh"]["signed_volume"].get<double>() == Approx(4.0 / 3 * 3.14159).epsilon(0.1));
    CHECK(run(folder, "info part.ply").out.find("closed") != std::string::npos);
    CHECK(run(folder, "info missing.off").status == 1);
}

TEST_CASE("compare measures both directions between a mesh and a cloud or a mesh", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 -o part.off").status == 0);
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 -o report.off --quiet --report report.json").status
            == 0);
    const Json result = Json::parse(run(folder, "compare scan.xyz part.off --json").out);
    const Json report = Json::parse(read_file(folder / "report.json"));
    CHECK(result["a"]["kind"] == "cloud");
    CHECK(result["b"]["mesh"]["closed"] == true);
    CHECK(result["a_to_b"]["max"].get<double>()
          == Approx(report["error"]["points_to_mesh_max"].get<double>()).epsilon(1e-6));
    CHECK(result["b_to_a"]["max"].get<double>() > 0);
    CHECK(result["hausdorff"].get<double>() >= result["a_to_b"]["max"].get<double>());
    const Json same = Json::parse(run(folder, "compare part.off part.off --json").out);
    CHECK(same["hausdorff"].get<double>() < 1e-9);
    CHECK(run(folder, "compare scan.xyz scan.xyz").status == 1);
    CHECK(run(folder, "compare scan.xyz").status == 2);
}

TEST_CASE("process runs modules in order and refuses unknown ones", "[cli]") {
    const Folder folder;
    const std::string modules = with_modules(folder);
    folder.write("scan.xyz", xyz(sphere_scan()));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 -o part.off").status == 0);
    CHECK(run(folder, "process --list", modules).out.find("classify-features") != std::string::npos);
    const CommandResult result = run(
        folder, "process part.off --module classify-features --module smooth-normals -o new.ply", modules);
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(exists(folder / "new.ply"));
    CHECK(run(folder, "process part.off --module no-such-module -o other.ply", modules).status == 1);
    CHECK(run(folder, "process part.off -o other.ply", modules).status == 2);
    CHECK_FALSE(exists(folder / "other.ply"));
}

TEST_CASE("modules beside the program are not found by walking up from it", "[cli]") {
    const Folder folder;
    with_modules(folder);
    fs::create_directories(folder / "bin");
    fs::create_directories(folder / "lib/hsdm");
    fs::rename(folder / "modules", folder / "lib/hsdm/plugins");
    fs::rename(folder / "lib/hsdm/plugins/smooth-normals.so",
               folder / "lib/hsdm/plugins/found-by-walking.so");
    fs::copy_file(HSDM_COMMAND, folder / "bin/hsdm");
    REQUIRE(run(folder, "--version; bin/hsdm process --list > listed").status == 0);
    CHECK(read_file(folder / "listed").find("found-by-walking") == std::string::npos);
    REQUIRE(
        run(folder, "--version; HSDM_PLUGIN_PATH=lib/hsdm/plugins bin/hsdm process --list > listed").status
        == 0);
    CHECK(read_file(folder / "listed").find("found-by-walking") != std::string::npos);
}

TEST_CASE("the suite that comes along passes", "[cli]") {
    const Folder folder;
    const CommandResult result = run(folder, "regress " HSDM_TESTDATA_DIR "/suite.json");
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.out.find("4 of 4 within tolerance") != std::string::npos);
}

TEST_CASE("regress passes within tolerance, fails outside it, and names what missed", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    const auto suite = [&folder](const std::string& expect) {
        folder.write("suite.json",
                     R"({"cases": [{"name": "sphere", "input": "scan.xyz", "args": ["--depth", "3"],
                                      "expect": )"
                         + expect + "}]}");
        return run(folder, "regress suite.json --json out.json");
    };
    CommandResult result = suite(R"({"mesh.closed": true, "mesh.euler": 2, "grid.depth": {"value": 3},
                                     "error.normalised_max": {"max": 0.05}, "mesh.faces": {"min": 10}})");
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.out.find("1 of 1 within tolerance") != std::string::npos);
    CHECK(Json::parse(read_file(folder / "out.json"))[0]["ok"] == true);
    for (const char* wrong :
         {R"({"mesh.closed": false})", R"({"mesh.faces": {"max": 10}})", R"({"mesh.faces": {"min": 1e9}})",
          R"({"mesh.faces": {"value": 10, "tolerance": 3}})", R"({"mesh.nothing": 1})",
          R"({"mesh.faces": {"maximum": 1e9}})"}) {
        INFO(wrong);
        result = suite(wrong);
        CHECK(result.status == 1);
        CHECK(result.out.find("MISS") != std::string::npos);
    }
    folder.write("broken.json", "{");
    CHECK(run(folder, "regress broken.json").status == 1);
    CHECK(run(folder, "regress missing.json").status == 1);
}
