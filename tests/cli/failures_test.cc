// One failure does not stop the rest, and is told with file and phase.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

using namespace hsdm;
using namespace hsdm::test;
using Json = nlohmann::json;

TEST_CASE("a level that fails leaves the other levels", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(4000)));
    // The finest voxels are far smaller than the spacing: there is no facet.
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --method basic --levels 4:9 -o part.off --report r.json");
    CHECK(result.status == 1);
    CHECK(result.err.find("hsdm: scan.xyz, depth 9: no facet") != std::string::npos);
    CHECK(read_file(folder / "part.d4.off").starts_with("OFF"));
    CHECK_FALSE(exists(folder / "part.d9.off"));
    const Json reports = Json::parse(read_file(folder / "r.json"));
    REQUIRE(reports.size() == 6);
    CHECK(reports[0]["mesh"]["closed"] == true);
    CHECK_FALSE(reports[0].contains("failure"));
    CHECK(reports[5]["failure"].get<std::string>().starts_with("no facet"));
    CHECK(reports[5]["grid"]["depth"] == 9);
    CHECK(reports[5]["input"]["file"] == "scan.xyz");
    // With nothing but failures it is one of the input.
    const CommandResult none = run(folder, "reconstruct scan.xyz --method basic --levels 9:10 -o none.off");
    CHECK(none.status == 1);
    CHECK(none.err.starts_with("hsdm: scan.xyz: no facet"));
}

TEST_CASE("options that do not fit one input fail that input alone", "[cli]") {
    const Folder folder;
    folder.write("a.xyz", xyz(sphere_scan(500)));
    folder.write("b.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n0 0 0\n");
    folder.write("large.xyz", "0 0 0\n1e9 0 0\n0 1e9 0\n0 0 1e9\n1e9 1e9 0\n");
    for (const char* options : {"a.xyz b.ply --columns x,y,z", "large.xyz a.xyz --voxel-size 0.3"}) {
        INFO(options);
        const CommandResult result = run(folder, std::string("reconstruct --out-dir out ") + options);
        CHECK(result.status == 1);
        CHECK(result.out.find("1 of 2 inputs done, 1 failed") != std::string::npos);
        CHECK(read_file(folder / "out/a.off").starts_with("OFF"));
    }
    CHECK(run(folder, "reconstruct large.xyz --voxel-size 0.3 -o a.off").status == 2);
    // What fits no input is refused before any work.
    const std::string before = list(folder);
    for (const char* options :
         {"--columns x,y", "--voxel-size -1", "--levels 3:17", "--crease-degrees 190"}) {
        INFO(options);
        CHECK(run(folder, std::string("reconstruct a.xyz b.ply --out-dir none ") + options).status == 2);
    }
    CHECK(list(folder) == before);
}

TEST_CASE("a single input that fails has a report too", "[cli]") {
    const Folder folder;
    folder.write("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n5 5 5\n");
    folder.write("large.xyz", "0 0 0\n1e9 0 0\n0 1e9 0\n0 0 1e9\n1e9 1e9 0\n");
    const auto failure = [&folder](const std::string& arguments, int status, bool in_list = false) {
        const CommandResult result = run(folder, "reconstruct " + arguments + " -o a.off --report r.json");
        INFO(arguments << '\n' << result.err);
        CHECK(result.status == status);
        const Json report = Json::parse(read_file(folder / "r.json"));
        const Json& entry = in_list ? report.at(0) : report;
        CHECK(entry["input"]["file"] == arguments.substr(0, arguments.find(' ')));
        CHECK(result.err.starts_with("hsdm: " + entry["failure"].get<std::string>() + '\n'));
        CHECK_FALSE(exists(folder / "a.off"));
    };
    failure("line.xyz", 1);
    failure("missing.xyz", 1);
    failure("line.xyz --levels 3:4", 1, true);
    failure("large.xyz --voxel-size 0.3", 2);
    // A report that cannot be written hides nothing.
    const CommandResult full = run(folder, "reconstruct line.xyz -o a.off --report /dev/full");
    CHECK(full.status == 1);
    CHECK(full.err.find("hsdm: line.xyz: ") != std::string::npos);
    CHECK(full.err.find("hsdm: /dev/full: ") != std::string::npos);
}

TEST_CASE("totals count the inputs that are done alone", "[cli]") {
    const Folder folder;
    folder.write("a.xyz", xyz(sphere_scan(500)));
    folder.write("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n5 5 5\n");
    const CommandResult result = run(folder, "reconstruct a.xyz line.xyz --depth 3 --out-dir out");
    CHECK(result.status == 1);
    CHECK(result.out.find("1 of 2 inputs done, 1 failed, 500 points, ") != std::string::npos);
}

#if !defined(HSDM_SANITIZED) // whose shadow memory needs the address space
TEST_CASE("the end of memory is told with file and phase, and the other inputs go on", "[cli]") {
    const Folder folder;
    // Needs far more than the limits, also where memory is managed otherwise.
    folder.write("large.xyz", xyz(sphere_scan(300000)));
    folder.write("small.xyz", xyz(sphere_scan(500)));
    for (const char* megabytes : {"40", "60"}) {
        const CommandResult result =
            run(folder,
                "reconstruct large.xyz small.xyz --depth 3 --threads 2 --quiet --out-dir out --format om "
                "--report r.json",
                std::string("ulimit -v $((1024 * ") + megabytes + "));");
        INFO(megabytes << ": " << result.err);
        CHECK(result.status == 1);
        CHECK(result.err.starts_with("hsdm: large.xyz: out of memory in phase "));
        CHECK(list(folder) == "large.xyz\nout\nr.json\nsmall.xyz\n");
        CHECK(read_file(folder / "out/small.om").starts_with("OM"));
        CHECK_FALSE(exists(folder / "out/large.om"));
        const Json reports = Json::parse(read_file(folder / "r.json"));
        CHECK(reports[0]["failure"].get<std::string>().find("out of memory in phase") != std::string::npos);
    }
    const std::string name = "large-with-a-name-that-no-small-string-holds.xyz";
    std::filesystem::rename(folder / "large.xyz", folder / name);
    const CommandResult alone = run(folder, "reconstruct " + name + " --depth 3 --threads 2 --quiet -o m.om",
                                    "ulimit -v $((1024 * 60));");
    CHECK(alone.status == 1);
    CHECK(alone.err.starts_with("hsdm: " + name + ": out of memory in phase "));
    std::filesystem::rename(folder / name, folder / "large.xyz");
    const CommandResult mesh = run(folder, "compare large.xyz small.xyz", "ulimit -v 38000;");
    CHECK(mesh.status == 1);
    CHECK(mesh.err.starts_with("hsdm: large.xyz: "));
    CHECK(mesh.err.find(" in phase read") != std::string::npos);
}
#endif
