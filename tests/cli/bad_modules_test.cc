// Modules that crash, hang, end the program or leave a broken mesh: the command says which, and writes
// nothing.
#include "cli/run.hh"
#include "cli/scan.hh"
#include "hsdm/io/read_mesh.hh"

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <set>
#include <tuple>

using namespace hsdm;
using namespace hsdm::test;
namespace fs = std::filesystem;

namespace {

constexpr const char* cube = "OFF\n8 6 12\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
                             "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

/// A folder with a mesh and the module `ill`; returns what makes modules known.
std::string with_ill_module(const Folder& folder) {
    const std::string modules = with_modules(folder);
    fs::copy_file(HSDM_ODD_MODULE_DIR "/ill.so", folder / "modules/ill.so");
    fs::permissions(folder / "modules/ill.so", fs::perms::owner_all);
    folder.write("cube.off", cube);
    folder.write("new.off", "old");
    return modules;
}

const std::string process = "process cube.off -o new.off --module classify-features --module ill:how=";

} // namespace

TEST_CASE("a broken mesh that a module leaves is an error that names it, and is not written", "[cli]") {
    const Folder folder;
    const std::string modules = with_ill_module(folder);
    for (const char* how : {"next", "far-vertex", "nan", "empty", "released"}) {
        INFO(how);
        const CommandResult result = run(folder, process + how + " --module smooth-normals", modules);
        CHECK(result.status == 1);
        CHECK(result.err.starts_with("hsdm: cube.off: ill: left "));
        CHECK(read_file(folder / "new.off") == "old");
    }
    CHECK(run(folder, process + "delete --format om", modules).status == 0);
    const PolygonMesh five = read_mesh(folder / "new.off");
    CHECK(five.facet_count() == 5);
    CHECK(five.sharp_edges.size() == 12);
}

TEST_CASE("a module that crashes is named before its signal ends the command", "[cli][threads]") {
    const Folder folder;
    const std::string modules = with_ill_module(folder);
    for (const auto& [how, status, name] :
         {std::tuple("abort", 134, "abort"), std::tuple("segv", 139, "segmentation fault"),
          std::tuple("overflow", 139, "segmentation fault")}) {
#if defined(HSDM_SANITIZED)
        if (std::string(how) == "overflow") continue; // their frames take too long to use up the stack
#endif
        INFO(how);
        const CommandResult result = run(folder, process + how, "ulimit -c 0; " + modules);
        CHECK(result.status == status);
        // The shell adds a line of its own.
        CHECK(result.err.starts_with(std::string("hsdm: cube.off: module ill crashed: ") + name + "\n"));
        CHECK(read_file(folder / "new.off") == "old");
        CHECK(folder.names() == std::set<std::string>{"cube.off", "modules", "new.off"});
    }
    const CommandResult ended = run(folder, process + "exit", modules);
    CHECK(ended.status == 1);
    CHECK(ended.err == "hsdm: cube.off: module ill ended the program\n");
    CHECK(read_file(folder / "new.off") == "old");
}

TEST_CASE("a module that crashes or ends the program in a suite is a miss of its case alone",
          "[cli][threads]") {
    const Folder folder;
    const std::string modules = with_ill_module(folder);
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    std::string cases;
    for (const char* stage : {"ill:how=segv", "ill:how=exit", "classify-features"})
        cases += std::string(cases.empty() ? "" : ", ") + R"({"name": ")" + stage
                 + R"(", "input": "scan.xyz", "args": ["--depth", "3", "--stage", ")" + stage
                 + R"("], "expect": {"mesh.closed": true}})";
    folder.write("suite.json", R"({"cases": [)" + cases + "]}");
    const CommandResult result =
        run(folder, "regress suite.json --junit r.xml --jobs 3", "ulimit -c 0; " + modules);
    INFO(result.out << result.err);
    CHECK(result.status == 1);
    CHECK(result.out.find("module ill crashed: segmentation fault; ended by signal 11 (Segmentation fault)\n")
          != std::string::npos);
    CHECK(result.out.find("module ill ended the program; ended by status 1\n") != std::string::npos);
    CHECK(result.out.find("1 of 3 within tolerance\n") != std::string::npos);
    const std::string xml = read_file(folder / "r.xml");
    CHECK(xml.find("printed:\nhsdm: ./scan.xyz: module ill crashed: segmentation fault\n")
          != std::string::npos);
}

TEST_CASE("a module that never asks is cancelled all the same, also the last one", "[cli][threads]") {
    const Folder folder;
    const std::string modules = with_ill_module(folder);
    for (const char* after : {"", " --module smooth-normals"}) {
        fs::remove(folder / "out"); // or the command would be thought to have come that far before
        const CommandResult shell =
            run(folder,
                process + "loop" + after
                    + " >out 2>err & command=$!; until grep -q classify-features out; do sleep 0.02; done; "
                      "sleep 0.1; start=$(date +%s%N); kill -TERM $command; wait $command; "
                      "echo $? $((($(date +%s%N) - start) / 1000000))",
                modules);
        int status = 0;
        long milliseconds = -1;
        REQUIRE(std::sscanf(shell.out.c_str(), "%d %ld", &status, &milliseconds) == 2);
        CHECK(status == 143);
        CHECK(milliseconds < 2000); // 0.2 s where nothing else runs
        CHECK(read_file(folder / "err") == "hsdm: cancelled; nothing was written\n");
        CHECK(read_file(folder / "new.off") == "old");
    }
}
