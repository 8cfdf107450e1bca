// Outputs never destroy an input or each other, and go wherever the user may write.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>

#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

using namespace hsdm;
using namespace hsdm::test;
namespace fs = std::filesystem;

namespace {

/// Refused at once, with both names in the message and every file as it was.
void check_refused(const Folder& folder, const std::string& arguments,
                   const std::vector<std::string>& words) {
    const std::string scan = read_file(folder / "scan.xyz"), before = list(folder);
    const CommandResult result = run(folder, arguments);
    INFO("hsdm " << arguments << '\n' << result.err);
    CHECK(result.status == 2);
    for (const std::string& word : words) CHECK(result.err.find(word) != std::string::npos);
    CHECK((read_file(folder / "scan.xyz") == scan));
    CHECK(list(folder) == before);
}

} // namespace

TEST_CASE("no output may be an input, by whatever name", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    fs::create_directories(folder / "sub/d4");
    for (const char* name : {"part.d4.off", "sub/d4/graph.obj", "scan.off"})
        fs::copy(folder / "scan.xyz", folder / name);
    fs::create_symlink("scan.xyz", folder / "link.off");
    fs::create_hard_link(folder / "scan.xyz", folder / "hard.off");
    const std::string read = "reconstruct --input-format xyz ";
    check_refused(folder, read + "scan.off -o scan.off", {"-o scan.off", "the input scan.off"});
    check_refused(folder, read + "scan.off -o sub/../scan.off", {"-o sub/../scan.off"});
    check_refused(folder, read + "scan.xyz -o link.off", {"-o link.off", "scan.xyz"});
    check_refused(folder, read + "scan.xyz -o hard.off", {"-o hard.off", "scan.xyz"});
    check_refused(folder, read + "part.d4.off --levels 3:4 -o part.off",
                  {"-o part.off (part.d4.off)", "the input part.d4.off"});
    check_refused(folder, read + "scan.xyz --levels 3:4 -o a.off --features scan.xyz --report scan.xyz",
                  {"--report scan.xyz", "the input scan.xyz"});
    check_refused(folder, read + "sub/d4/graph.obj -o a.off --debug-dir sub",
                  {"--debug-dir sub", "the input sub/d4/graph.obj"});
    check_refused(folder, read + "scan.off part.d4.off --out-dir .", {"--out-dir .", "scan.off"});
    check_refused(folder, read + "- -o scan.xyz --format off <scan.xyz", {"-o scan.xyz", "standard input"});
    check_refused(folder, read + "scan.xyz -o a.off >>scan.xyz", {"the input scan.xyz"});
    // What the phases of this depth do not hold is free.
    CHECK(run(folder, read + "sub/d4/graph.obj -o a.off --debug-dir sub --depth 3 --quiet").status == 0);
}

TEST_CASE("no two outputs may be one file, there or not", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    fs::create_directory(folder / "sub");
    fs::copy(folder / "scan.xyz", folder / "sub/scan.xyz");
    fs::create_symlink("a.off", folder / "to-a");
    const std::string command = "reconstruct scan.xyz ";
    check_refused(folder, command + "-o a.off --report a.off", {"-o a.off", "--report a.off"});
    check_refused(folder, command + "-o a.off --features new/../a.off", {"--features new/../a.off"});
    check_refused(folder, command + "-o a.off --report to-a", {"-o a.off", "--report to-a"});
    check_refused(folder, command + "-o - --report /dev/stdout", {"-o -", "--report /dev/stdout"});
    check_refused(folder, command + "-o - --report -", {"-o -", "--report -"});
    check_refused(folder, command + "-o debug/d4/facets.off --debug-dir debug --depth 4",
                  {"-o debug/d4/facets.off", "--debug-dir debug"});
    check_refused(folder, command + "sub/scan.xyz --out-dir made", {"--out-dir made"});
    CHECK_FALSE(exists(folder / "made"));
    CHECK(run(folder, command + "--quiet -o /dev/null --report /dev/null --features /dev/null").status == 0);
}

TEST_CASE("phases of several inputs have folders of their own", "[cli]") {
    const Folder folder;
    for (const char* name : {"a.xyz", "b.xyz"}) folder.write(name, xyz(sphere_scan(500)));
    REQUIRE(run(folder, "reconstruct a.xyz b.xyz --depth 3 --out-dir out --debug-dir dbg").status == 0);
    for (const char* name : {"dbg/a/d3/facets.off", "dbg/b/d3/facets.off", "dbg/b/d3/voxels.obj"})
        CHECK(exists(folder / name));
}

TEST_CASE("process and regress destroy neither mesh nor suite nor cloud", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 --quiet -o m.off").status == 0);
    with_modules(folder);
    const std::string process = "process m.off --module ./modules/classify-features.so ";
    check_refused(folder, process + "-o ./m.off", {"-o ./m.off", "the mesh m.off", "--in-place"});
    check_refused(folder, process + "-o other.off --in-place", {"--in-place"});
    const std::string module = "--module ./modules/classify-features.so ";
    check_refused(folder, "process - --in-place " + module + "<m.off", {"standard input", "-o FILE"});
    for (const std::string& words :
         {process + "-o modules/classify-features.so --format off", process + "-o new.off >>m.off",
          "process - -o m.off " + module + "<m.off"}) {
        check_refused(folder, words, {"would be destroyed"});
        CHECK(run(folder, words).err.find("--in-place") == std::string::npos); // it would not help
    }
    CHECK(run(folder, process + "-o m.off --in-place --quiet").status == 0);
    CHECK(run(folder, process + "--in-place --quiet").status == 0);
    CHECK(read_file(folder / "m.off").starts_with("OFF"));
    const std::string suite = R"({"cases": [{"input": "scan.xyz", "args": ["--depth", "3"],
                                          "expect": {"mesh.closed": true}}]})";
    folder.write("suite.json", suite);
    check_refused(folder, "regress suite.json --json suite.json", {"--json suite.json", "the suite"});
    check_refused(folder, "regress suite.json --json ./scan.xyz", {"--json ./scan.xyz", "the input"});
    check_refused(folder, "regress suite.json --junit suite.json", {"--junit suite.json", "the suite"});
    check_refused(folder, "regress suite.json --junit ./scan.xyz --filter .",
                  {"--junit ./scan.xyz", "the input"});
    check_refused(folder, "regress suite.json --json r --junit ./r", {"--json r", "--junit ./r"});
    CHECK(read_file(folder / "suite.json") == suite);
    const CommandResult piped = run(folder, "regress suite.json --json -");
    CHECK(piped.status == 0);
    CHECK(piped.out.starts_with("[")); // and the table gave way
    CHECK(piped.err.find("within tolerance") != std::string::npos);
}

TEST_CASE("info and compare do not write into what they read", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(100)));
    folder.write("m.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    check_refused(folder, "info scan.xyz >>scan.xyz", {"the output is the file scan.xyz"});
    check_refused(folder, "info - <scan.xyz >>scan.xyz", {"the output is standard input"});
    check_refused(folder, "compare m.off scan.xyz 1<>scan.xyz", {"the output is the file scan.xyz"});
    check_refused(folder, "compare scan.xyz m.off --json 1<>scan.xyz", {"the output is the file scan.xyz"});
    CHECK(run(folder, "compare scan.xyz m.off >new.txt").status == 0);
    CHECK(run(folder, "compare m.off m.off </dev/null >/dev/null").status == 0);
}

TEST_CASE("devices, descriptors and pipes are outputs for any user", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 --quiet -o a.off").status == 0);
    const std::string mesh = read_file(folder / "a.off"), command = "reconstruct scan.xyz --depth 3 ";
    // An ordinary user's, who may write neither to this folder nor to /dev.
    REQUIRE(chmod(folder.path().c_str(), 0755) == 0);
    std::string user = "setpriv --reuid 65534 --regid 65534 --clear-groups";
    if (geteuid() != 0 || run(folder, "--version", user).status != 0) user = "";
    CHECK(run(folder, command + "--quiet -o /dev/null", user).status == 0);
    CHECK((run(folder, command + "-o /dev/stdout", user).out == mesh));
    CHECK((run(folder, command + "-o /dev/fd/1 | cat", user).out == mesh));
    CHECK((run(folder, command + "--quiet -o /proc/self/fd/3 3>&1", user).out == mesh));
    const CommandResult through =
        run(folder, command + "--quiet -o pipe & cat pipe; wait $!", "mkfifo pipe;");
    CHECK((through.out == mesh));
    CHECK((run(folder, command + "-o /dev/stdout | cat", "echo first;").out == "first\n" + mesh));
    if (!user.empty()) CHECK(run(folder, command + "-o b.off", user).status == 1);
}
