#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::json;

namespace {

/// The first line on standard error; the status must be 2 and nothing written.
std::string refusal(const Folder& folder, const std::string& arguments) {
    const std::string before = list(folder);
    const CommandResult result = run(folder, arguments);
    INFO(arguments << '\n' << result.err);
    CHECK(result.status == 2);
    CHECK(result.out.empty());
    CHECK(list(folder) == before);
    return result.err.substr(0, result.err.find('\n'));
}

/// Rows of six numbers: points of the unit sphere and as many normals of this length.
std::string with_normals(double length) {
    std::string text;
    char line[160];
    for (const Vec3& p : sphere_scan(1000).positions) {
        std::snprintf(line, sizeof line, "%.9g %.9g %.9g %.9g %.9g %.9g\n", p[0], p[1], p[2], length * p[0],
                      length * p[1], length * p[2]);
        text += line;
    }
    return text;
}

/// A PLY file of points, the first of them not finite.
std::string ply_with_nan(const PointCloud& cloud) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(cloud.size() + 1)
           + "\nproperty double x\nproperty double y\nproperty double z\nend_header\nnan 0 0\n" + xyz(cloud);
}

} // namespace

TEST_CASE("unknown words are refused with the nearest known one", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(100)));
    CHECK(refusal(folder, "recnstruct scan.xyz -o a.off")
          == "hsdm: recnstruct: there is no such subcommand; did you mean reconstruct?");
    CHECK_THAT(refusal(folder, "frobnicate"), Contains("there are reconstruct, info, compare"));
    CHECK_THAT(refusal(folder, "help recnstruct"), Contains("did you mean reconstruct?"));
    CHECK_THAT(refusal(folder, ""), StartsWith("hsdm: a subcommand is needed: reconstruct"));
    CHECK(refusal(folder, "reconstruct scan.xyz -o a.off --dept 5")
          == "hsdm: --dept: reconstruct has no such option; did you mean --depth?");
    CHECK_THAT(refusal(folder, "reconstruct scan.xyz --ot-dir=x"), Contains("did you mean --out-dir?"));
    CHECK_THAT(refusal(folder, "--verison"), Contains("did you mean --version?"));
    CHECK_THAT(refusal(folder, "info --jso"), Contains("did you mean --json?"));
    CHECK(refusal(folder, "info scan.xyz --zzzzzzzz") == "hsdm: --zzzzzzzz: info has no such option");
    CHECK(refusal(folder, "info scan.xyz other.xyz") == "hsdm: other.xyz: one argument too many for info");
    CHECK_THAT(refusal(folder, "reconstruct scan.xyz -o a.off --method extendet"),
               Contains("--method extendet: must be one of") && Contains("did you mean extended?"));
}

TEST_CASE("every line of a message says whose it is", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", "0 0 0\n");
    const CommandResult result = run(folder, "reconstruct scan.xyz -o a.off --out-dir out");
    CHECK(result.status == 2);
    std::istringstream lines(result.err);
    for (std::string line; std::getline(lines, line);) CHECK_THAT(line, StartsWith("hsdm: "));
    CHECK_THAT(result.err, Contains("--help"));
}

TEST_CASE("help and version work as words", "[cli]") {
    const Folder folder;
    CHECK(run(folder, "help").out == run(folder, "--help").out);
    CHECK(run(folder, "help reconstruct").out == run(folder, "reconstruct --help").out);
    CHECK(run(folder, "version").out == run(folder, "--version").out);
    for (const char* words : {"help", "help reconstruct", "version"}) CHECK(run(folder, words).status == 0);
    CHECK_THAT(run(folder, "version").out, StartsWith("hsdm "));
    CHECK(run(folder, "help >/dev/full").status == 1);
}

TEST_CASE("an option at fault is named as it was written, with its bounds in its own units", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(100)));
    const std::pair<const char*, const char*> wrong[] = {
        {"--depth 0", "must be a whole number from 1 to 16"},
        {"--depth 17", "must be a whole number from 1 to 16"},
        {"--depth 4.5", "must be a whole number from 1 to 16"},
        {"--depth 99999999999", "must be a whole number from 1 to 16"},
        {"--voxel-size -1", "must be a length above 0"},
        {"--voxel-size nan", "must be a length above 0"},
        {"--voxel-size 1e-9", "must be at least"},
        {"--max-error 0", "a length above 0 or a percentage"},
        {"--smoothing -1", "0 or more"},
        {"--threads -1", "0 (all) or more"},
        {"--min-component 200%", "up to 100%"},
        {"--crease-degrees 0", "must lie between 0 and 180"},
        {"--crease-degrees 180", "must lie between 0 and 180"},
        {"--crease-degrees 400", "must lie between 0 and 180"},
        {"--crease-degrees nan", "must lie between 0 and 180"},
        {"--levels 7:3", "two depths from 1 to 16"},
        {"--levels 0:4", "two depths from 1 to 16"},
        {"--levels 4:17", "two depths from 1 to 16"},
        {"--levels 4", "e.g. 4:7"},
        {"--columns q", "\"q\" is no column"},
        {"--input-format e57", "must be one of ply, pcd, xyz"},
        {"--normals estimate --method basic", "uses no normals"},
        {"--max-error 1 --grid uniform", "no bound to keep"},
        {"--depth 4 --voxel-size 1", "cannot be given together"},
        {"--depth 4 --depth 5", "can be given only once"},
        {"--depth", "its value is missing"},
    };
    for (const auto& [options, reason] : wrong) {
        const std::string said = refusal(folder, "reconstruct scan.xyz -o a.off " + std::string(options));
        const std::string words = options;
        CHECK_THAT(said, StartsWith("hsdm: " + words.substr(0, words.find(' '))) && Contains(reason));
    }
    folder.write("mesh.off", "OFF\n0 0 0\n");
    CHECK_THAT(refusal(folder, "reconstruct mesh.off -o a.off --columns x,y,z"),
               StartsWith("hsdm: --columns: mesh.off is no table"));
    CHECK_THAT(refusal(folder, "process mesh.off -o a.off --module a:b"), StartsWith("hsdm: --module a:b: "));
    CHECK(refusal(folder, "reconstruct scan.xyz -o a.off --crease-degrees 400")
          == "hsdm: --crease-degrees 400: must lie between 0 and 180");
}

TEST_CASE("a name that no file can have is told in the command's words", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(100)));
    const std::string name(300, 'a');
    for (const std::string& words : {"reconstruct scan.xyz -o " + name + ".off", "info " + name + ".off"}) {
        const CommandResult result = run(folder, words);
        CHECK(result.status == 1);
        CHECK_THAT(result.err, StartsWith("hsdm: aaa") && Contains("too long") && !Contains("filesystem"));
    }
}

TEST_CASE("control characters in names are written out, in messages and summaries", "[cli]") {
    const Folder folder;
    const std::string name = "a\nb\x1b[31m\xff\xc2\x9b\xc3\xa9.xyz", said = R"(a\x0ab\x1b[31m\xff\xc2\x9b)"
                                                                            "\xc3\xa9.xyz";
    folder.write(name, "nothing\n");
    const CommandResult bad = run(folder, "info '" + name + "'");
    CHECK(bad.status == 1);
    CHECK_THAT(bad.err, StartsWith("hsdm: " + said + ":1: "));
    folder.write(name, xyz(sphere_scan(300)));
    CHECK_THAT(run(folder, "info '" + name + "'").out, Contains("file      " + said + "\n"));
    const std::string result = run(folder, "reconstruct '" + name + "' --depth 3 -o '" + name + ".off'").out;
    CHECK_THAT(result, Contains("written   " + said + ".off in"));
    CHECK_THAT(run(folder, "compare '" + name + "' '" + name + ".off'").out, Contains(said + ".off\n"));
}

TEST_CASE("the progress bar is wiped before the summary is printed", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(300)));
    const std::string words = " reconstruct scan.xyz --levels 3:4 -o a.off --progress always";
    REQUIRE(
        run(folder, "--version; script -qec \"'" HSDM_COMMAND "'" + words + "\" /dev/null >terminal").status
        == 0);
    const std::string shown = read_file(folder / "terminal");
    const std::string wiped = "\r\x1b[K";
    REQUIRE(shown.find('%') != std::string::npos);
    const std::size_t at = shown.find("a.d3.off: ");
    REQUIRE((at != std::string::npos && at >= wiped.size()));
    CHECK(shown.substr(at - wiped.size(), wiped.size()) == wiped);
}

TEST_CASE("info and compare drop the points that reconstruct drops, and say how many", "[cli]") {
    const Folder folder;
    folder.write("scan.ply", ply_with_nan(sphere_scan(1000)));
    const CommandResult made = run(folder, "reconstruct scan.ply --depth 3 -o part.off --report r.json");
    REQUIRE(made.status == 0);
    const Json input = Json::parse(read_file(folder / "r.json"))["input"];
    CHECK(input["dropped_nonfinite"] == 1);
    CHECK(input["first_nonfinite"] == 0);
    CHECK_THAT(made.out, Contains("1 without finite coordinates, the first at index 0, dropped"));
    CHECK_THAT(run(folder, "info scan.ply").out, Contains("1 point without finite coordinates"));
    CHECK(Json::parse(run(folder, "info scan.ply --json").out)["cloud"]["dropped_nonfinite"] == 1);
    CHECK_THAT(run(folder, "compare scan.ply part.off").out, Contains("1 point without finite coordinates"));
    const Json compared = Json::parse(run(folder, "compare scan.ply part.off --json").out);
    CHECK(compared["a"]["dropped_nonfinite"] == 1);
    CHECK(compared["a"]["points"] == 1000);
}

TEST_CASE("pixels and rays without a return are counted with what is dropped", "[cli]") {
    const Folder folder;
    const std::string points = xyz(sphere_scan(1000));
    folder.write("scan.pcd", "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\n"
                             "WIDTH 1002\nHEIGHT 1\nPOINTS 1002\nDATA ascii\n"
                                 + points + "nan nan nan\nnan nan nan\n");
    REQUIRE(run(folder, "reconstruct scan.pcd --depth 3 -o part.off --report r.json").status == 0);
    CHECK(Json::parse(read_file(folder / "r.json"))["input"]["dropped_nonfinite"] == 2);
    CHECK(Json::parse(run(folder, "info scan.pcd --json").out)["cloud"]["dropped_nonfinite"] == 2);
    const Json compared = Json::parse(run(folder, "compare scan.pcd part.off --json").out);
    CHECK(compared["a"]["dropped_nonfinite"] == 2);
    folder.write("suite.json", R"({"cases": [{"name": "pixels", "input": "scan.pcd", "args": ["--depth", "3"],
                                              "expect": {"input.dropped_nonfinite": 2}}]})");
    CHECK(run(folder, "regress suite.json").status == 0);
}

TEST_CASE("a mesh on standard input, or under another name, is a mesh", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    for (const char* format : {"off", "ply", "stl", "obj"}) {
        INFO(format);
        const std::string mesh = "part." + std::string(format);
        REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 -o " + mesh).status == 0);
        const Json info = Json::parse(run(folder, "info - --json", "cat " + mesh + " |").out);
        CHECK(info["kind"] == "mesh");
        CHECK(info["mesh"] == Json::parse(run(folder, "info --json " + mesh).out)["mesh"]);
        CHECK(Json::parse(run(folder, "compare - scan.xyz --json", "cat " + mesh + " |").out)["a"]["kind"]
              == "mesh");
    }
    CHECK(run(folder, "--version; cp part.ply part.txt").status == 0);
    CHECK(Json::parse(run(folder, "info part.txt --json").out)["kind"] == "mesh");
    CHECK(Json::parse(run(folder, "info - --json", "cat scan.xyz |").out)["kind"] == "cloud");
    CHECK_THAT(refusal(folder, "compare - -"), Contains("standard input"));
}

TEST_CASE("every format that is read by its name can be given as --input-format", "[cli]") {
    const Folder folder;
    folder.write("scan.dat", xyz(sphere_scan(300)));
    for (const char* format : {"xyz", "txt", "asc", "csv", "pts"}) {
        INFO(format);
        CHECK(run(folder, "reconstruct scan.dat --depth 3 -o a.off --input-format " + std::string(format))
                  .status
              == 0);
    }
    CHECK_THAT(run(folder, "help reconstruct").out,
               Contains("ply|pcd|xyz|xyzn|xyzrgb|csv|txt|asc|pts|pwn|ptx|las|npy|npz|off|obj|stl|om|hoppe"));
}

TEST_CASE("what columns were taken for is said, and when normals are not of unit length", "[cli]") {
    const Folder folder;
    folder.write("unit.xyz", with_normals(1));
    folder.write("long.xyz", with_normals(1.4));
    const std::string names = " --columns x,y,z,nx,ny,nz";
    CHECK_THAT(run(folder, "info unit.xyz").out,
               Contains("normals   yes\n") && Contains("columns   x,y,z,nx,ny,nz, told from the values\n"));
    CHECK_THAT(run(folder, "info long.xyz").out, Contains("no three are unit vectors; --columns"));
    CHECK(Json::parse(run(folder, "info long.xyz --json").out)["cloud"]["columns"]
          == "x,y,z,column_4,column_5,column_6");
    const CommandResult told = run(folder, "reconstruct long.xyz --depth 3 -o a.off --report r.json");
    CHECK_THAT(told.out, Contains("normals estimated") && Contains("no three are unit vectors"));
    CHECK(Json::parse(read_file(folder / "r.json"))["options"]["columns"]
          == "x,y,z,column_4,column_5,column_6");
    const std::string given = run(folder, "reconstruct long.xyz --depth 3 -o a.off" + names).out;
    CHECK_THAT(given, Contains("with normals") && !Contains("told from the values"));
    folder.write("named.xyz", "x y z nx ny nz\n" + with_normals(1.4));
    const std::string info = run(folder, "info named.xyz").out;
    CHECK_THAT(info, Contains("normals   yes, not of unit length (1.4 to 1.4)") && !Contains("told"));
}

TEST_CASE("JSON holds no null: what is not finite is left out", "[cli]") {
    const Folder folder;
    folder.write("huge.off", "OFF\n4 4 6\n0 0 0\n1e120 0 0\n0 1e120 0\n0 0 1e120\n"
                             "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    folder.write("point.xyz", "1 2 3\n");
    for (const char* words :
         {"info huge.off --json", "info point.xyz --json", "compare huge.off point.xyz --json"}) {
        const CommandResult result = run(folder, words);
        INFO(words << result.out << result.err);
        CHECK(result.status == 0);
        CHECK_THAT(result.out, !Contains("null"));
    }
    const Json huge = Json::parse(run(folder, "info huge.off --json").out);
    CHECK(huge["mesh"]["faces"] == 4);
    CHECK_FALSE(huge["mesh"].contains("signed_volume"));
}

TEST_CASE("what a suite's cases ask for wrongly is told in words of the command", "[cli]") {
    const Folder folder;
    CHECK_THAT(run(folder, "regress .").err, StartsWith("hsdm: .: is a directory"));
    folder.write("scan.xyz", xyz(sphere_scan(300)));
    folder.write("suite.json", R"({"cases": [{"input": "scan.xyz", "args": ["--depth", "99"],
                                              "expect": {"mesh.closed": true}},
                                             {"input": "scan.xyz", "args": ["--dept", "3"],
                                              "expect": {"mesh.closed": true}},
                                             {"input": "scan.xyz", "expect": {"rejected.a~b/c": 1}}]})");
    const CommandResult missed = run(folder, "regress suite.json");
    CHECK_THAT(missed.out, Contains("args: --depth 99: must be a whole number from 1 to 16"));
    CHECK_THAT(missed.out, Contains("args: --dept: a case has no such option; did you mean --depth?"));
    CHECK_THAT(missed.out, Contains("rejected.a~b/c is not in the report"));
}

TEST_CASE("what is dropped and threads that are not started are said", "[cli]") {
    const Folder folder;
    PointCloud cloud = support::sample(support::sphere(1), {.points = 4000});
    cloud.positions.emplace_back(1e7, 2e7, 0);
    cloud.normals.emplace_back(1, 0, 0);
    support::write_ply(folder / "scan.ply", cloud);
    const CommandResult result = run(folder, "reconstruct scan.ply -o a.off --threads 2000");
    CHECK(result.status == 0);
    CHECK_THAT(result.out,
               Catch::Contains("dropped   points far from all others: 1, the first at 1e+07 2e+07 0"));
    CHECK_THAT(result.err, Catch::Contains("hsdm: --threads 2000: 256 are used"));
}
