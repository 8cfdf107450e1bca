#include "cli/run.hh"
#include "cli/scan.hh"
#include "hsdm/io/read_mesh.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// 1 x 2 x 3, times a power of two.
std::string box_off(int exponent) {
    std::ostringstream off;
    off << std::setprecision(17) << "OFF\n8 6 12\n";
    for (int corner = 0; corner < 8; ++corner)
        off << std::ldexp(corner & 1, exponent) << ' ' << std::ldexp(corner & 2, exponent) << ' '
            << std::ldexp(corner & 4 ? 3 : 0, exponent) << '\n';
    off << "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    return off.str();
}

} // namespace

TEST_CASE("info tells a cloud from a mesh and measures both", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 -o part.ply").status == 0);
    const Json cloud = Json::parse(run(folder, "info scan.xyz --json").out);
    CHECK(cloud["kind"] == "cloud");
    CHECK(cloud["cloud"]["points"] == 4000);
    CHECK(cloud["cloud"]["spacing"].get<double>() == Approx(0.056).epsilon(0.15));
    CHECK(cloud["cloud"]["nearest"]["median"].get<double>() < cloud["cloud"]["spacing"].get<double>());
    CHECK(cloud["cloud"]["duplicates"] == 0);
    CHECK(cloud["cloud"]["isolated"] == 0);
    CHECK(cloud["cloud"]["statistical_outliers"].get<double>() < 0.02);
    const Json mesh = Json::parse(run(folder, "info part.ply --json").out);
    CHECK(mesh["kind"] == "mesh");
    CHECK(mesh["mesh"]["closed"] == true);
    CHECK(mesh["mesh"]["manifold"] == true);
    CHECK(mesh["mesh"]["signed_volume"].get<double>() == Approx(4.0 / 3 * 3.14159).epsilon(0.1));
    CHECK(run(folder, "info part.ply").out.find("closed") != std::string::npos);
    CHECK(run(folder, "info missing.off").status == 1);
}

TEST_CASE("info tells of a cloud's strays and repeated points", "[cli]") {
    const Folder folder;
    PointCloud scan = sphere_scan();
    for (int i = 0; i < 40; ++i) scan.positions.emplace_back(0, 2 + 0.3 * i, 3);
    for (int i = 0; i < 3; ++i) scan.positions.push_back(scan.positions[5]);
    folder.write("scan.xyz", xyz(scan));
    const Json cloud = Json::parse(run(folder, "info scan.xyz --json").out)["cloud"];
    CHECK(cloud["points"] == 4043);
    CHECK(cloud["duplicates"] == 3);
    CHECK(cloud["isolated"].get<double>() == Approx(40.0 / 4040));
    const std::string text = run(folder, "info scan.xyz").out;
    CHECK(text.find("repeated  3 points") != std::string::npos);
    CHECK(text.find("outliers  0.990099 % lie 3 medians from their 8 nearest") != std::string::npos);
    CHECK(text.find("density   nearest other point of 5 % within ") != std::string::npos);
    folder.write("one.xyz", "1 2 3\n1 2 3\n");
    const Json one = Json::parse(run(folder, "info one.xyz --json").out)["cloud"];
    CHECK(one["duplicates"] == 1);
    CHECK(one["spacing"] == 0);
}

TEST_CASE("info measures meshes of any size", "[cli]") {
    const Folder folder;
    folder.write("box.off", box_off(0));
    const Json box = Json::parse(run(folder, "info box.off --json").out);
    REQUIRE(box["mesh"]["signed_volume"] == 6.0);
    for (const int exponent : {-500, -320, 320, 500}) {
        INFO("2^" << exponent);
        folder.write("other.off", box_off(exponent));
        Json other = Json::parse(run(folder, "info other.off --json").out);
        CHECK(other["diagonal"] == std::ldexp(box["diagonal"].get<double>(), exponent));
        Json expected = box["mesh"];
        expected["edge_length_mean"] = std::ldexp(box["mesh"]["edge_length_mean"].get<double>(), exponent);
        expected["signed_volume"] = std::ldexp(6.0, 3 * exponent);
        if (std::abs(exponent) == 500) expected.erase("signed_volume");       // no number holds it
        for (Json* mesh : {&expected, &other["mesh"]}) mesh->erase("digest"); // of other positions
        CHECK(other["mesh"] == expected);
        CHECK(run(folder, "info other.off").out.find("(outward)") != std::string::npos);
    }
}

TEST_CASE("modules find in meshes of extreme size what they find in others", "[cli]") {
    const Folder folder;
    const std::string modules = with_modules(folder);
    folder.write("box.off", box_off(0));
    const std::string words = " --module classify-features --module smooth-normals ";
    const CommandResult box = run(folder, "process box.off -o new.off" + words, modules);
    REQUIRE(box.out.find("12 sharp edges") != std::string::npos);
    CHECK(box.err.empty());
    for (const int exponent : {-500, 500}) {
        folder.write("other.off", box_off(exponent));
        const CommandResult other = run(folder, "process other.off -o other-new.off" + words, modules);
        INFO(other.err);
        CHECK(other.status == 0);
        CHECK(other.out == box.out);
        CHECK(other.err.starts_with("hsdm: other.off: "));
        CHECK(other.err.find("units of 2^" + std::to_string(exponent + 1)) != std::string::npos);
        CHECK(run(folder, "process other.off -o other-new.off --quiet" + words, modules).err.empty());
        const Json compared = Json::parse(run(folder, "compare other.off other-new.off --json").out);
        CHECK(compared["hausdorff"].get<double>() <= std::ldexp(1e-9, exponent));
    }
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
    CHECK(run(folder, "compare scan.xyz").status == 2);
}

TEST_CASE("compare measures both directions between two clouds", "[cli]") {
    const Folder folder;
    PointCloud scan = sphere_scan();
    folder.write("scan.xyz", xyz(scan));
    for (Vec3& p : scan.positions) p *= 1.125;
    scan.positions.emplace_back(0, 0, 3);
    folder.write("grown.xyz", xyz(scan));
    const Json result = Json::parse(run(folder, "compare scan.xyz grown.xyz --json").out);
    CHECK(result["a"]["kind"] == "cloud");
    CHECK(result["b"]["points"] == 4001);
    CHECK(result["a_to_b"]["max"].get<double>() < 0.2);
    CHECK(result["a_to_b"]["median"].get<double>() == Approx(0.125).epsilon(0.1));
    CHECK(result["b_to_a"]["max"].get<double>() == Approx(2).epsilon(0.01));
    CHECK(result["b_to_a"]["p99"].get<double>() < 0.2);
    CHECK(result["hausdorff"] == result["b_to_a"]["max"]);
    const std::string text = run(folder, "compare grown.xyz scan.xyz").out;
    CHECK(text.find("cloud     4,001 points") != std::string::npos);
    CHECK(text.find("a to b  max ") != std::string::npos);
    CHECK(text.find("99 % within ") != std::string::npos);
    const Json same = Json::parse(run(folder, "compare scan.xyz scan.xyz --json").out);
    CHECK(same["hausdorff"] == 0);
    CHECK(same["a_to_b"]["normalised_max"] == 0);
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
          R"({"mesh.faces": {"value": 10, "tolerance": 3}})", R"({"rejected.nothing": 1})"}) {
        INFO(wrong);
        result = suite(wrong);
        CHECK(result.status == 1);
        CHECK(result.out.find("MISS") != std::string::npos);
    }
    folder.write("broken.json", "{");
    CHECK(run(folder, "regress broken.json").status == 2);
    CHECK(run(folder, "regress missing.json").status == 1);
}

TEST_CASE("regress runs the cases that --filter names and says how many it leaves out", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    std::string cases;
    for (const char* name : {"sphere, coarse", "sphere, fine", "part"})
        cases += (cases.empty() ? "" : ", ")
                 + Json{{"name", name},
                        {"input", "scan.xyz"},
                        {"args", {"--depth", "3"}},
                        {"expect", {{"mesh.closed", true}}}}
                       .dump();
    folder.write("suite.json", R"({"cases": [)" + cases + "]}");
    const CommandResult some =
        run(folder, "regress suite.json --filter '^sphere.*(fine|coarse)$' --json r.json");
    INFO(some.out << some.err);
    CHECK(some.status == 0);
    CHECK(some.out.ends_with("2 of 2 within tolerance, 1 left out by --filter\n"));
    const Json results = Json::parse(read_file(folder / "r.json"));
    REQUIRE(results.size() == 2);
    CHECK(results[1]["name"] == "sphere, fine");
    CHECK_FALSE(results[1].contains("interrupted"));
    CommandResult refused = run(folder, "regress suite.json --filter cube");
    CHECK(refused.status == 2);
    CHECK(refused.err.starts_with("hsdm: --filter cube: matches the name of no case of suite.json\n"));
    refused = run(folder, "regress suite.json --filter '('");
    CHECK(refused.status == 2);
    CHECK(refused.err.starts_with("hsdm: --filter (: is no regular expression"));
}

TEST_CASE("regress writes what missed as JUnit's XML", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    folder.write("suite.json", R"({"cases": [
        {"name": "good", "input": "scan.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": true}},
        {"name": "<a & \"b\">\u0007\uffff", "input": "scan.xyz", "args": ["--depth", "3"],
         "expect": {"mesh.closed": false, "mesh.genus": 7}},
        {"name": "none", "input": "missing.xyz", "expect": {"mesh.closed": true}}]})");
    const CommandResult result = run(folder, "regress suite.json --junit r.xml");
    INFO(result.out << result.err);
    CHECK(result.status == 1);
    const std::string xml = read_file(folder / "r.xml");
    for (const char* part : {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n",
                             "<testsuite name=\"suite.json\" package=\"hsdm\" id=\"0\" timestamp=\"",
                             "tests=\"3\" failures=\"1\" errors=\"1\" time=\"",
                             "<testcase classname=\"suite.json\" name=\"good\" time=\"",
                             "name=\"&lt;a &amp; &quot;b&quot;&gt;\\x07\\uffff\" time=\"",
                             "<failure message=\"mesh.closed is true, expected false\" type=\"out of "
                             "tolerance\">mesh.closed is true, expected false\n"
                             "mesh.genus is 0, expected 7\n</failure>\n",
                             "<error message=\"./missing.xyz: "}) {
        INFO(part);
        CHECK(xml.find(part) != std::string::npos);
    }
    CHECK(xml.ends_with("</testsuite>\n</testsuites>\n"));
    const CommandResult piped = run(folder, "regress suite.json --junit -");
    CHECK(piped.out.starts_with("<?xml")); // and the table gave way
    CHECK(piped.err.find("1 of 3 within tolerance") != std::string::npos);
}

TEST_CASE("what is written as .om is read by every command, with its sharp edges", "[cli]") {
    const Folder folder;
    const std::string modules = with_modules(folder);
    support::SampleOptions scan;
    scan.points = 8000;
    support::write_ply(folder / "scan.ply", support::sample(support::box({2, 1, 1}), scan));
    REQUIRE(run(folder, "reconstruct scan.ply --depth 4 -o part.om --features lines.txt").status == 0);
    const PolygonMesh part = read_mesh(folder / "part.om");
    REQUIRE(part.sharp_edges.size() > 100);
    const std::string lines = read_file(folder / "lines.txt");
    CHECK(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'))
          == part.sharp_edges.size() + 8);

    CHECK(Json::parse(run(folder, "info part.om --json").out)["mesh"]["closed"] == true);
    CHECK(Json::parse(run(folder, "compare part.om part.om --json").out)["hausdorff"] < 1e-9);
    CHECK(run(folder, "process part.om --module smooth-normals -o smoothed.om", modules).status == 0);
    const PolygonMesh smoothed = read_mesh(folder / "smoothed.om");
    CHECK(smoothed.sharp_edges == part.sharp_edges);
    CHECK(smoothed.corners == part.corners);
    CHECK(run(folder, "process part.om --module smooth-normals -o - --format om > piped.om", modules).status
          == 0);
    CHECK(read_file(folder / "piped.om") == read_file(folder / "smoothed.om"));
    folder.write("suite.json", R"({"cases": [{"name": "again", "input": "part.om", "args": ["--depth", "3"],
                                   "expect": {"mesh.closed": true}}]})");
    CHECK(run(folder, "regress suite.json").status == 0);
}

TEST_CASE("process keeps the normals of creases of a mesh that has classes but no marks", "[cli]") {
    const Folder folder;
    const std::string modules = with_modules(folder);
    support::SampleOptions scan;
    scan.points = 20000;
    support::write_ply(folder / "scan.ply", support::sample(support::mechanical_part(), scan));
    REQUIRE(run(folder, "reconstruct scan.ply --depth 5 -o part.ply --features lines.txt").status == 0);
    REQUIRE(run(folder, "process part.ply --module smooth-normals:rounds=0 -o new.ply", modules).status == 0);
    REQUIRE(run(folder, "process part.ply --module smooth-normals:rounds=0 -o new.om", modules).status == 0);
    const auto count_of_normals = [&](const char* name) {
        for (const VertexProperty& property : read_mesh(folder / name).properties)
            if (property.name == "hsdm_normal_count") return property.values;
        return std::vector<double>();
    };
    const std::vector<double> before = count_of_normals("part.ply"), after = count_of_normals("new.ply");
    REQUIRE(before.size() == after.size());
    std::size_t several = 0, lost = 0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        several += before[v] > 1;
        lost += before[v] > after[v];
    }
    CHECK(several > 200);
    CHECK(lost == 0);
    // Where a crease is one edge long the facets beside it are one fan at both ends, and normals do not tell.
    std::istringstream lines(read_file(folder / "lines.txt"));
    std::vector<std::array<std::string, 2>> edges;
    std::map<std::string, int> ends;
    for (std::string x, y, z, u, v, w; lines >> x && x != "c" && lines >> y >> z >> u >> v >> w;) {
        edges.push_back({x + ' ' + y + ' ' + z, u + ' ' + v + ' ' + w});
        for (const std::string& end : edges.back()) ++ends[end];
    }
    const auto lone = std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
        return ends[edge[0]] == 1 && ends[edge[1]] == 1;
    });
    const std::size_t sharp = edges.size() - static_cast<std::size_t>(lone);
    INFO(lone << " of " << edges.size() << " alone");
    CHECK(lone < 10);
    CHECK(static_cast<double>(read_mesh(folder / "new.om").sharp_edges.size())
          == Approx(static_cast<double>(sharp)).margin(2));
}
