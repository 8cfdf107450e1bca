// hsdm regress: what a case may expect beyond the report, cases side by side, suites renewed.
#include "cli/run.hh"
#include "cli/scan.hh"

#include "hsdm/io/write_mesh.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

#include <sys/stat.h>

using namespace hsdm;
using namespace hsdm::test;

namespace {

using OrderedJson = nlohmann::ordered_json;
using Catch::Matchers::Contains;

/// The members of a case of the sphere's scan, but for its `expect`.
const std::string sphere_case = R"("input": "scan.xyz", "args": ["--depth", "3"])";

CommandResult regress(const Folder& folder, const std::string& cases, const std::string& arguments = "") {
    folder.write("suite.json", R"({"cases": [)" + cases + "]}");
    return run(folder, "regress suite.json " + arguments);
}

OrderedJson results_of(const Folder& folder, const std::string& name = "r.json") {
    return OrderedJson::parse(read_file(folder / name));
}

/// Without what differs from run to run.
OrderedJson without_times(OrderedJson results) {
    for (OrderedJson& one : results) {
        for (const char* key : {"seconds", "peak_memory_bytes", "machine_seconds"}) one.erase(key);
        if (one["report"].is_null()) continue;
        for (const char* key : {"seconds", "peak_memory_bytes", "threads"}) one["report"].erase(key);
        for (OrderedJson& stage : one["report"]["stages"]) stage.erase("seconds");
    }
    return results;
}

std::string digest_of(const Folder& folder, const std::string& mesh) {
    return OrderedJson::parse(run(folder, "info --json " + mesh).out)["mesh"]["digest"];
}

class ScanFolder : public Folder {
public:
    ScanFolder() { write("scan.xyz", xyz(sphere_scan(1000))); }
};

} // namespace

TEST_CASE("closed standard descriptors change no file that is written", "[cli]") {
    const ScanFolder folder;
    const std::string one = "{" + sphere_case + R"(, "expect": {"mesh.genus": 0}})";
    REQUIRE(regress(folder, one, "--json open.json").status == 0);
    for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&-", "<&- >&- 2>&-"}) {
        INFO(closed);
        regress(folder, one, std::string("--json closed.json ") + closed);
        CHECK(without_times(results_of(folder, "closed.json"))
              == without_times(results_of(folder, "open.json")));
    }
}

TEST_CASE("a mesh has one digest, whatever it is written as, and a case can expect it", "[cli]") {
    const ScanFolder folder;
    for (const char* format : {"off", "ply", "obj", "om"})
        REQUIRE(
            run(folder, std::string("reconstruct scan.xyz --depth 3 --quiet --report r.json -o a.") + format)
                .status
            == 0);
    const std::string digest = results_of(folder)["mesh"]["digest"];
    CHECK(digest.size() == 16);
    for (const char* format : {"off", "ply", "obj", "om"})
        CHECK(digest_of(folder, std::string("a.") + format) == digest);
    const auto expecting = [&](const std::string& text) {
        return regress(folder, "{" + sphere_case + R"(, "expect": {"mesh.digest": ")" + text + "\"}}");
    };
    CHECK(expecting(digest).status == 0);
    const CommandResult missed = expecting("0123456789abcdef");
    CHECK(missed.status == 1);
    CHECK_THAT(missed.out, Contains("mesh.digest is \"" + digest + "\", expected \"0123456789abcdef\""));
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 4 --quiet -o b.off").status == 0);
    CHECK(digest_of(folder, "b.off") != digest);
}

TEST_CASE("a case can expect shape as info tells it, and a count of intersections", "[cli]") {
    const ScanFolder folder;
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 --quiet -o a.off").status == 0);
    const OrderedJson told = OrderedJson::parse(run(folder, "info --json a.off").out)["mesh"];
    REQUIRE(regress(folder,
                    "{" + sphere_case + R"(, "expect": {"mesh.scaled_jacobian_min": {"min": -1}}},{)"
                        + sphere_case + R"(, "expect": {"mesh.intersections": 0}})",
                    "--json r.json")
                .status
            == 0);
    const OrderedJson results = results_of(folder);
    for (const char* key :
         {"quad_share", "scaled_jacobian_median", "scaled_jacobian_min", "edge_length_mean", "digest"})
        CHECK(results[0]["report"]["mesh"][key] == told[key]);
    CHECK_FALSE(results[0]["report"]["mesh"].contains("intersections")); // counted where it is asked for
    CHECK(results[1]["report"]["mesh"]["intersections"] == 0);
}

TEST_CASE("a case can be held against the true surface, a mesh or a cloud", "[cli]") {
    const ScanFolder folder;
    folder.write("dense.xyz", xyz(sphere_scan(20000)));
    REQUIRE(run(folder, "reconstruct dense.xyz --depth 5 --quiet -o true.off").status == 0);
    for (const char* reference : {"true.off", "dense.xyz"}) {
        INFO(reference);
        const CommandResult result =
            regress(folder, "{" + sphere_case + R"(, "reference": ")" + reference + R"(",
                "expect": {"reference.mesh_to_reference.mean": {"max": 0.03},
                           "reference.reference_to_mesh.p99": {"min": 0.001, "max": 0.05},
                           "reference.hausdorff": {"value": 0.04, "tolerance": 0.03}}})",
                    "--json r.json");
        INFO(result.out << result.err);
        CHECK(result.status == 0);
        REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 --quiet -o a.off").status == 0);
        const OrderedJson compared =
            OrderedJson::parse(run(folder, std::string("compare --json a.off ") + reference).out);
        const OrderedJson said = results_of(folder)[0]["report"]["reference"];
        CHECK(said["mesh_to_reference"] == compared["a_to_b"]);
        CHECK(said["reference_to_mesh"] == compared["b_to_a"]);
    }
    const CommandResult missed = regress(
        folder, "{" + sphere_case + R"(, "reference": "true.off", "expect": {"reference.hausdorff": 0}})");
    CHECK(missed.status == 1);
    CHECK_THAT(missed.out, Contains("reference.hausdorff is "));
    const CommandResult absent = regress(
        folder, "{" + sphere_case + R"(, "reference": "none.off", "expect": {"reference.hausdorff": 0}})");
    CHECK(absent.status == 1);
    CHECK_THAT(absent.out, Contains("none.off"));
}

TEST_CASE("a case can have its mesh written in a format and read back", "[cli]") {
    const ScanFolder folder;
    for (const char* format : {"off", "stl", "ply", "obj", "om"})
        for (const char* more :
             {"", R"(, "--plain")", R"(, "--ascii")", R"(, "--stage", "smooth-normals")"}) {
            INFO(format << more);
            const CommandResult result = regress(
                folder,
                R"({"input": "scan.xyz", "args": ["--depth", "3")" + std::string(more) + R"(], "output": ")"
                    + format + R"(", "expect": {"output.bytes": {"min": 1000}, "mesh.closed": true}})",
                "--json r.json");
            INFO(result.out << result.err);
            CHECK(result.status == 0);
            const OrderedJson report = results_of(folder)[0]["report"];
            CHECK(report["output"]["format"] == format);
            CHECK((report["output"]["digest"] == report["mesh"]["digest"]) == (format != std::string("stl")));
        }
    CHECK(list(folder) == "r.json\nscan.xyz\nsuite.json\n");
}

TEST_CASE("STL of a cloud far from the origin is text, and its corners are where they were", "[cli]") {
    const Folder folder;
    PointCloud far = sphere_scan(1000);
    for (Vec3& p : far.positions) p += Vec3(1e7, 1e7, 0);
    folder.write("scan.xyz", xyz(far));
    CHECK(regress(folder,
                  "{" + sphere_case + R"(, "output": "stl", "expect": {"output.text_for_precision": true}})")
              .status
          == 0);
}

TEST_CASE("what a case expects of a file or a surface that it does not name is refused", "[cli]") {
    const ScanFolder folder;
    const auto refused = [&](const std::string& rest) {
        const CommandResult result = regress(folder, "{" + sphere_case + ", " + rest + "}");
        return result.status == 2 && result.out.empty() ? result.err : "not refused: " + result.out;
    };
    CHECK_THAT(refused(R"("expect": {"reference.hausdorff": 0})"),
               Contains("suite.json: case 1: expects something of a `reference`, but names none"));
    CHECK_THAT(refused(R"("reference": "a.off", "expect": {"mesh.closed": true})"),
               Contains("names a `reference`, but expects nothing of it"));
    CHECK_THAT(refused(R"("expect": {"output.bytes": 0})"), Contains("expects something of an `output`"));
    CHECK_THAT(refused(R"("output": "step", "expect": {"mesh.closed": true})"),
               Contains("`output` must be off, stl, ply, obj or om"));
    CHECK_THAT(refused(R"("reference": "a", "expect": {"reference.hausdorf": 0})"),
               Contains("which no report has; did you mean reference.hausdorff?"));
    CHECK_THAT(
        regress(folder, R"({"input": "scan.xyz", "args": ["--ascii"], "expect": {"mesh.closed": true}})").out,
        Contains("--ascii is about a file, but the case has no `output`"));
}

TEST_CASE("cases side by side give the rows and results of cases one by one", "[cli][threads]") {
    const ScanFolder folder;
    folder.write("large.xyz", xyz(sphere_scan(6000)));
    std::string cases = R"({"name": "first", "input": "large.xyz", "args": ["--depth", "5"],
                            "expect": {"mesh.closed": true}})";
    for (int i = 0; i < 7; ++i) {
        cases += R"(, {"name": "case )" + std::to_string(i) + "\", " + sphere_case + R"(, "output": ")"
                 + (i % 2 == 0 ? "om" : "stl") + R"(", "expect": )"
                 + (i == 3 ? R"({"mesh.closed": false}})" : R"({"mesh.intersections": 0}})");
    }
    cases += R"(, {"name": "broken", "input": "missing.xyz", "expect": {"mesh.closed": true}})";
    cases += R"(, {"name": "staged", "input": "scan.xyz", "args": ["--depth", "3", "--stage", "quads"],
                   "expect": {"mesh.closed": true}})";
    const auto rows = [](const std::string& out) { // without seconds and memory, the last columns
        std::string text;
        for (std::size_t begin = 0; begin < out.size();) {
            const std::size_t end = out.find('\n', begin);
            const std::string line = out.substr(begin, end - begin);
            const bool is_row = line.starts_with("ok") || line.starts_with("MISS");
            const std::size_t seconds = line.find_last_not_of(' ', line.rfind(' '));
            const std::size_t error = line.find_last_not_of(' ', line.rfind(' ', seconds));
            text += (is_row ? line.substr(0, error + 1) : line) + '\n';
            begin = end + 1;
        }
        return text;
    };
    const CommandResult one = regress(folder, cases, "--json 1.json");
    CHECK(one.status == 1);
    for (const char* jobs : {"2", "4", "64"}) {
        const CommandResult many = regress(folder, cases, std::string("--json n.json --jobs ") + jobs);
        CHECK(many.status == 1);
        CHECK(rows(many.out) == rows(one.out));
        CHECK(without_times(results_of(folder, "n.json")) == without_times(results_of(folder, "1.json")));
    }
    CHECK(regress(folder, cases, "--jobs 0").status == 2);
}

TEST_CASE("an update writes what was found and leaves every other byte", "[cli]") {
    const ScanFolder folder;
    const std::string before =
        "\xef\xbb\xbf{ \"cases\":\n[\t{\"expect\" : {\"mesh.closed\": true,\n"
        "  \"mesh\\u002efaces\":{\"relative\":0.01, \"value\" :7 }, \"mesh.quads\": 12 ,\n"
        "  \"error.normalised_max\": {\"max\": 1e-9,\"min\":0}, \"mesh.digest\" : \"\"},\n"
        "  \"name\": \"a \\\"]}{\", \"input\":\"scan.xyz\", \"args\": [\"--depth\",\"3\"]}\n,"
        "{\"input\":\"scan.xyz\",\"expect\":{\"mesh.euler\": {\"value\": 2.0}}}] } \n\n";
    folder.write("suite.json", before);
    REQUIRE(chmod((folder / "suite.json").c_str(), 0640) == 0);
    REQUIRE(run(folder, "regress suite.json").status == 1);
    CHECK(read_file(folder / "suite.json") == before); // only when asked to

    const CommandResult updated = run(folder, "regress suite.json --update --json r.json");
    INFO(updated.out << updated.err);
    CHECK(updated.status == 0);
    const OrderedJson mesh = results_of(folder)[0]["report"]["mesh"];
    const std::string error = results_of(folder)[0]["report"]["error"]["normalised_max"].dump();
    std::string expected = before;
    const auto replace = [&expected](const std::string& from, const std::string& to) {
        expected.replace(expected.find(from), from.size(), to);
    };
    replace(":7 }", ":" + mesh["faces"].dump() + " }");
    replace("12 ,", mesh["quads"].dump() + " ,");
    replace("1e-9", error);
    replace("\"\"}", mesh["digest"].dump() + "}");
    CHECK(read_file(folder / "suite.json") == expected);
    CHECK_THAT(updated.out, Contains("mesh.faces value 7 -> " + mesh["faces"].dump() + "\n")
                                && Contains("error.normalised_max max 1e-09 -> " + error + "\n")
                                && Contains("4 expectations of suite.json renewed\n"));
    struct stat status {};
    REQUIRE(stat((folder / "suite.json").c_str(), &status) == 0);
    CHECK((status.st_mode & 07777) == 0640);
    CHECK(run(folder, "regress suite.json").status == 0);

    const CommandResult again = run(folder, "regress suite.json --update");
    CHECK(again.status == 0);
    CHECK_THAT(again.out, Contains("no expectation of suite.json changes\n"));
    struct stat later {};
    REQUIRE(stat((folder / "suite.json").c_str(), &later) == 0);
    CHECK(later.st_ino == status.st_ino);
}

TEST_CASE("an update keeps to the cases of the filter, and to what it can mend", "[cli]") {
    const ScanFolder folder;
    const std::string wrong = sphere_case + R"(, "expect": {"mesh.genus": 5})";
    const std::string cases = R"({"name": "a", )" + wrong + R"(}, {"name": "b", )" + wrong + "}";
    CHECK(regress(folder, cases, "--update --filter b").status == 0);
    const OrderedJson suite = results_of(folder, "suite.json");
    CHECK(suite["cases"][0]["expect"]["mesh.genus"] == 5);
    CHECK(suite["cases"][1]["expect"]["mesh.genus"] == 0);
    for (const char* hopeless :
         {R"({"input": "missing.xyz", "expect": {"mesh.genus": 5}})",
          R"({"input": "scan.xyz", "args": ["--depth", "3"], "expect": {"rejected.nothing": 1}})",
          R"({"input": "scan.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": {"min": 1}}})"}) {
        const CommandResult result = regress(folder, hopeless, "--update");
        INFO(result.out);
        CHECK(result.status == 1);
        CHECK_THAT(result.out, Contains("no expectation of suite.json changes"));
    }
    // one of two
    CHECK(regress(folder, "{" + sphere_case + R"(, "expect": {"rejected.nothing": 1, "mesh.genus": 5}})",
                  "--update")
              .status
          == 1);
    CHECK(results_of(folder, "suite.json")["cases"][0]["expect"]["mesh.genus"] == 0);
}

TEST_CASE("an update writes only into a file, which nobody changed meanwhile", "[cli]") {
    const ScanFolder folder;
    const std::string suite = R"({"cases": [{"input": "late.xyz", "args": ["--depth", "3"],
                                             "expect": {"mesh.genus": 5}}]})";
    folder.write("suite.json", suite);
    CHECK_THAT(run(folder, "regress - --update", "cat suite.json |").err, Contains("must be a file"));
    CHECK(run(folder, "regress - --update", "cat suite.json |").status == 2);
    CHECK(run(folder, "regress suite.json --update --json suite.json").status == 2);
    REQUIRE(mkfifo((folder / "late.xyz").c_str(), 0600) == 0);
    const CommandResult changed = run(
        folder,
        "regress suite.json --update & { sleep 0.3; echo >> suite.json; cat scan.xyz; } > late.xyz; wait $!");
    CHECK(changed.status == 1);
    CHECK_THAT(changed.err, Contains("suite.json: was changed while its cases ran"));
    CHECK(read_file(folder / "suite.json") == suite + "\n");
}

TEST_CASE("reconstruct counts intersections when it is asked to, in summary and report", "[cli]") {
    const ScanFolder folder;
    const CommandResult told =
        run(folder, "reconstruct scan.xyz --depth 3 -o a.off --intersections --report r.json");
    CHECK(told.status == 0);
    CHECK_THAT(told.out, Contains("genus 0, 0 intersections\n"));
    CHECK(results_of(folder)["mesh"]["intersections"] == 0);
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 3 -o a.off --report r.json").status == 0);
    CHECK_FALSE(results_of(folder)["mesh"].contains("intersections"));
    CHECK(run(folder, "reconstruct scan.xyz --depth 3 -o a.off --intersections --quiet").status == 2);
}
