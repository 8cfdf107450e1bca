// A signal ends the command at once, wherever it is, and leaves nothing half done.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <cstdio>

#include <sys/stat.h>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Starts the command in the background, waits until `ready` (a shell condition) holds, sends the signal, and
/// gives the status and the messages; the end must come soon. A pipe `wait` is there, which nobody writes to
/// or reads from. Threads that the end interrupts are no leak to the thread sanitizer.
CommandResult end_by(const Folder& folder, const std::string& signal, const std::string& arguments,
                     const std::string& ready) {
    const CommandResult shell =
        run(folder,
            arguments + " >out 2>err & command=$!; until " + ready
                + "; do kill -0 $command || break; sleep 0.02; done; start=$(date +%s%N); kill -" + signal
                + " $command; wait $command; echo $? $((($(date +%s%N) - start) / 1000000)); rm -f wait",
            "[ -p wait ] || mkfifo wait; export TSAN_OPTIONS=\"$TSAN_OPTIONS report_thread_leaks=0\";");
    CommandResult result;
    long milliseconds = -1;
    REQUIRE(std::sscanf(shell.out.c_str(), "%d %ld", &result.status, &milliseconds) == 2);
    CHECK(milliseconds < 2000); // 0.2 s where nothing else runs
    result.out = read_file(folder / "out");
    result.err = read_file(folder / "err");
    return result;
}

/// True once the command has started to catch signals: the mask of what it blocks has SIGINT.
const std::string catching = "grep -q 'SigBlk:.*[2367abef]$' /proc/$command/status";

} // namespace

TEST_CASE("every signal that ends a program ends this one with 128 + its number and no file",
          "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    const std::pair<const char*, int> signals[] = {
        {"INT", 130}, {"TERM", 143}, {"HUP", 129}, {"QUIT", 131}, {"XCPU", 152}};
    for (const auto& [signal, status] : signals) {
        INFO(signal);
        // Opened for both, the pipe gives nothing and does not end.
        const CommandResult result =
            end_by(folder, signal, "reconstruct - --input-format xyz -o a.off <>wait", catching);
        CHECK(result.status == status);
        CHECK(result.err == "hsdm: cancelled; nothing was written\n");
        CHECK(list(folder) == "err\nout\nscan.xyz\n");
    }
}

TEST_CASE("a signal is not kept waiting by work without end", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(4000)));
    const std::string work =
        "reconstruct scan.xyz --depth 5 -o a.ply --smoothing 100000000 --progress always";
    const CommandResult result = end_by(folder, "TERM", work, "grep -q features err");
    CHECK(result.status == 143);
    CHECK(result.err.ends_with("hsdm: cancelled; nothing was written\n"));
    CHECK_FALSE(exists(folder / "a.ply"));
}

TEST_CASE("a signal is not kept waiting by pipes", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    with_modules(folder);
    for (const char* arguments :
         {"info wait", "compare wait scan.xyz", "compare scan.xyz wait", "regress wait",
          "process wait --module ./modules/classify-features.so -o a.off",
          "reconstruct scan.xyz --depth 3 -o wait --format off --quiet"}) {
        INFO(arguments);
        const CommandResult result = end_by(folder, "INT", arguments, catching);
        CHECK(result.status == 130);
        CHECK(result.err == "hsdm: cancelled; nothing was written\n");
    }
}

TEST_CASE("after a signal the message says what stands and what is there in part", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    const std::string command = "reconstruct scan.xyz --depth 3 --quiet -o a.off ";
    // The second file waits for a reader.
    CommandResult result = end_by(folder, "INT", command + "--features wait", "[ -f a.off ]");
    CHECK(result.status == 130);
    CHECK(result.err == "hsdm: cancelled; written before: a.off\n");
    CHECK(exists(folder / "a.off"));
    // A pipe that is full: some of the mesh was read from it and cannot be taken back.
    folder.write("scan.xyz", xyz(sphere_scan(4000)));
    result = end_by(folder, "INT", "reconstruct scan.xyz --depth 5 --quiet -o /dev/fd/3 --format off 3<>wait",
                    "head -c 3 wait >/dev/null");
    CHECK(result.status == 130);
    CHECK(result.err == "hsdm: cancelled; in part: /dev/fd/3\n");
    CHECK(list(folder) == "a.off\nerr\nout\nscan.xyz\n");
}

TEST_CASE("a signal during a suite leaves the rows and results of the cases that are done",
          "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    REQUIRE(mkfifo((folder / "stuck.xyz").c_str(), 0600) == 0);
    folder.write("suite.json", R"({"cases": [
        {"name": "first", "input": "scan.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": true}},
        {"name": "second", "input": "stuck.xyz", "expect": {"mesh.closed": true}},
        {"name": "third", "input": "scan.xyz", "expect": {"mesh.closed": true}}]})");
    const auto end_after_first = [&folder](const std::string& signal, const std::string& arguments) {
        for (const char* old : {"out", "r.json", "r.xml"}) std::remove((folder / old).c_str());
        return end_by(folder, signal, arguments, "grep -q '^ok    first' out 2>/dev/null");
    };
    const std::pair<const char*, int> signals[] = {{"INT", 130}, {"TERM", 143}};
    for (const auto& [signal, status] : signals) {
        INFO(signal);
        const CommandResult result =
            end_after_first(signal, "regress suite.json --json r.json --junit r.xml");
        CHECK(result.status == status);
        CHECK(result.err == "hsdm: cancelled; written before: r.json, r.xml\n");
        const auto results = nlohmann::json::parse(read_file(folder / "r.json"));
        REQUIRE(results.size() == 2);
        CHECK(results[0]["ok"] == true);
        CHECK_FALSE(results[0].contains("interrupted"));
        CHECK(results[1]["name"] == "second");
        CHECK(results[1]["ok"] == false);
        CHECK(results[1]["interrupted"] == true);
        CHECK(read_file(folder / "r.xml").find("<error message=\"interrupted\" type=\"interrupted\">")
              != std::string::npos);
        CHECK(list(folder) == "err\nout\nr.json\nr.xml\nscan.xyz\nstuck.xyz\nsuite.json\n");
    }
    // Side by side each keeps its place, whichever was done first.
    CHECK(end_after_first("INT", "regress suite.json --jobs 2 --json r.json").status == 130);
    const auto results = nlohmann::json::parse(read_file(folder / "r.json"));
    REQUIRE(results.size() >= 2);
    CHECK(results[0]["name"] == "first");
    CHECK(results[1]["name"] == "second");
    CHECK(results[1]["interrupted"] == true);
    if (results.size() > 2) CHECK(results[2]["name"] == "third");
    // What goes into a pipe may have to wait for a reader, and a signal does not.
    const CommandResult piped = end_after_first("INT", "regress suite.json --json wait");
    CHECK(piped.status == 130);
    CHECK(piped.err == "hsdm: cancelled; nothing was written\n");
}

TEST_CASE("no case of a suite outlives it, whatever ends it", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    REQUIRE(mkfifo((folder / "stuck.xyz").c_str(), 0600) == 0);
    folder.write("suite.json", R"({"cases": [
        {"name": "first", "input": "scan.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": true}},
        {"name": "second", "input": "stuck.xyz", "expect": {"mesh.closed": true}}]})");
    const std::string commands_here =
        "for p in /proc/[0-9]*; do [ \"$(cat $p/comm 2>/dev/null)\" = hsdm ] && "
        "[ \"$(readlink $p/cwd)\" = \"$PWD\" ] && echo $p; done";
    for (const char* signal : {"INT", "KILL"}) {
        INFO(signal);
        std::remove((folder / "out").c_str());
        CHECK(end_by(folder, signal, "regress suite.json",
                     "grep -q '^ok    first' out 2>/dev/null && [ $(" + commands_here + " | wc -l) = 2 ]")
                  .status
              > 128);
        const CommandResult left =
            run(folder, "--version; for i in $(seq 200); do left=$(" + commands_here
                            + "); [ -z \"$left\" ] && break; sleep 0.02; done; echo \"left:$left\"");
        CHECK(left.out.ends_with("left:\n"));
    }
}

TEST_CASE("a signal that was ignored stays so where shells do not do it for every job", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    const CommandResult result =
        run(folder,
            "reconstruct - --input-format xyz --depth 3 --quiet -o a.off <wait & command=$!; exec 3>wait; "
            "until "
                + catching
                + "; do sleep 0.02; done; kill -HUP $command; cat scan.xyz >&3; exec 3>&-; "
                  "wait $command; echo $?",
            "trap '' HUP; mkfifo wait;");
    CHECK(result.out == "0\n");
    CHECK(exists(folder / "a.off"));
}

TEST_CASE("a limit on the size of files is an error of writing, and leaves nothing", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(4000)));
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --depth 5 --quiet -o a.off", "ulimit -f 64;");
    CHECK(result.status == 1);
    CHECK(result.err.starts_with("hsdm: a.off: cannot write: File too large"));
    CHECK(list(folder) == "scan.xyz\n");
}

TEST_CASE("a run that was killed leaves a temporary file, which the next one removes and names",
          "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    folder.write(".a.off.4711-0.tmp", "OFF");
    const CommandResult result = run(folder, "reconstruct scan.xyz --depth 3 --quiet -o a.off");
    CHECK(result.status == 0);
    CHECK(result.err == "hsdm: removed .a.off.4711-0.tmp, left by a run that was killed\n");
    CHECK(list(folder) == "a.off\nscan.xyz\n");
}
