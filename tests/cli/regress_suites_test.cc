// Suites of hsdm regress: inputs by pattern, cases that must fail or crash, JUnit's XML by its schema.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>

using namespace hsdm;
using namespace hsdm::test;
namespace fs = std::filesystem;

namespace {

using OrderedJson = nlohmann::ordered_json;
using Catch::Matchers::Contains;

CommandResult regress_suite(const Folder& folder, const std::string& cases,
                            const std::string& arguments = "") {
    folder.write("suite.json", R"({"cases": [)" + cases + "]}");
    return run(folder, "regress suite.json " + arguments);
}

/// The names of the cases in the results.
std::vector<std::string> names_in(const Folder& folder) {
    std::vector<std::string> names;
    for (const OrderedJson& one : OrderedJson::parse(read_file(folder / "r.json")))
        names.push_back(one["name"]);
    return names;
}

/// A case of these files that expects a closed mesh.
std::string closed(const std::string& input, const std::string& name = "") {
    return "{" + (name.empty() ? "" : R"("name": ")" + name + "\", ") + R"("input": ")" + input
           + R"(", "args": ["--depth", "3"], "expect": {"mesh.closed": true}})";
}

void make_scans(const Folder& folder) {
    const std::string scan = xyz(sphere_scan(500));
    for (const char* name : {"scans", "scans/deep", "scans/deep/er", "scans/.hidden"})
        fs::create_directory(folder / name);
    for (const char* name :
         {"scans/b.xyz", "scans/a.xyz", "scans/a10.xyz", "scans/.c.xyz", "scans/deep/d.xyz",
          "scans/deep/er/e.xyz", "scans/.hidden/f.xyz", "scans/\xc3\xa9.xyz", "scans/part[1].xyz"})
        folder.write(name, scan);
    folder.write("scans/note.txt", "no scan");
}

} // namespace

TEST_CASE("an input that is a pattern stands for a case per file, sorted and named by the file", "[cli]") {
    const Folder folder;
    make_scans(folder);
    fs::create_directory(folder / "scans/folder.xyz");
    const auto names = [&](const std::string& pattern, const std::string& name = "") {
        const CommandResult result = regress_suite(folder, closed(pattern, name), "--json r.json");
        INFO(pattern << '\n' << result.out << result.err);
        CHECK(result.status == 0);
        return result.status == 0 ? names_in(folder) : std::vector<std::string>{result.err};
    };
    using Names = std::vector<std::string>;
    CHECK(names("scans/*.xyz")
          == Names{"scans/a.xyz", "scans/a10.xyz", "scans/b.xyz", "scans/part[1].xyz", "scans/\xc3\xa9.xyz"});
    CHECK(names("scans/?.xyz", "coarse")
          == Names{"coarse: scans/a.xyz", "coarse: scans/b.xyz", "coarse: scans/\xc3\xa9.xyz"});
    CHECK(names("scans/[!a-m].xyz") == Names{"scans/\xc3\xa9.xyz"});
    CHECK(names("scans/.*.xyz") == Names{"scans/.c.xyz"});
    CHECK(names("*/deep/*.xyz") == Names{"scans/deep/d.xyz"});
    CHECK(names("scans/**/[de].xyz") == Names{"scans/deep/d.xyz", "scans/deep/er/e.xyz"});
    CHECK(names("**/a*0.xyz") == Names{"scans/a10.xyz"});
    CHECK(names(folder / "scans/deep/*").front() == folder / "scans/deep/d.xyz");
    // What is a file's name is that file.
    CHECK(names("scans/part[1].xyz") == Names{"scans/part[1].xyz"});
}

TEST_CASE("patterns are below a suite's root, and one that no file is as is refused", "[cli]") {
    const Folder folder;
    make_scans(folder);
    fs::create_directory(folder / "suites");
    folder.write("suites/suite.json", R"({"root": "../scans", "cases": [)" + closed("[ab].xyz") + "]}");
    CHECK(run(folder, "regress suites/suite.json --json r.json").status == 0);
    CHECK(names_in(folder) == std::vector<std::string>{"a.xyz", "b.xyz"});
    for (const char* pattern : {"scans/*.ply", "nowhere/*.xyz", "scans/*.xyz/*", "**/scans/x?z"}) {
        INFO(pattern);
        const CommandResult result = regress_suite(folder, closed("scans/a.xyz") + ',' + closed(pattern));
        CHECK(result.status == 2);
        CHECK(result.out.empty());
        CHECK_THAT(result.err, Contains("suite.json: case 2: no file is as `input` says: ./"));
    }
}

TEST_CASE("a file whose name is no text is a case like others, and found in a baseline", "[cli]") {
    const Folder folder;
    folder.write("\xff\n.xyz", xyz(sphere_scan(500)));
    REQUIRE(regress_suite(folder, closed("*.xyz"), "--json r.json --html r.html").status == 0);
    CHECK(names_in(folder) == std::vector<std::string>{"\\xff\\x0a.xyz"});
    CHECK_THAT(regress_suite(folder, closed("*.xyz"), "--baseline r.json").out, Contains(" 0 new\n"));
}

TEST_CASE("an update gives a case of several files bounds that hold for all", "[cli]") {
    const Folder folder;
    folder.write("a.xyz", xyz(sphere_scan(500)));
    folder.write("b.xyz", xyz(sphere_scan(3000)));
    const std::string suite = R"({"cases": [{"input": "?.xyz", "args": ["--depth", "3"], "expect":
        {"mesh.vertices": {"min": 1e6}, "mesh.faces": {"max": 1}, "mesh.closed": false}}]})";
    folder.write("suite.json", suite);
    CHECK(run(folder, "regress suite.json --update --json r.json").status == 0);
    const OrderedJson found = OrderedJson::parse(read_file(folder / "r.json"));
    const auto all = [&found](const char* key) {
        return std::minmax({found[0]["report"]["mesh"][key].get<int>(),
                            found[1]["report"]["mesh"][key].get<int>()}); // a list, whose values are copied
    };
    const OrderedJson expect = OrderedJson::parse(read_file(folder / "suite.json"))["cases"][0]["expect"];
    CHECK(expect["mesh.vertices"]["min"] == all("vertices").first);
    CHECK(expect["mesh.faces"]["max"] == all("faces").second);
    CHECK(expect["mesh.closed"] == true);
    CHECK(run(folder, "regress suite.json").status == 0);
    // No one digest is that of two meshes.
    const CommandResult differing = regress_suite(
        folder, R"({"input": "?.xyz", "args": ["--depth", "3"], "expect": {"mesh.digest": ""}})", "--update");
    CHECK(differing.status == 1);
    CHECK_THAT(differing.out, Contains("no expectation of suite.json changes"));
}

TEST_CASE("an update leaves an expectation of a whole object, which no value is", "[cli]") {
    const Folder folder;
    make_scans(folder);
    const std::string one =
        R"({"input": "scans/a.xyz", "args": ["--depth", "3"], "expect": {"grid": 3, "grid.depth": 4}})";
    const CommandResult result = regress_suite(folder, one, "--update");
    INFO(result.out << result.err);
    CHECK(result.status == 1);
    CHECK_THAT(read_file(folder / "suite.json"), Contains(R"({"grid": 3, "grid.depth": 3})"));
}

TEST_CASE("a case that must fail passes when it does as it says, and misses otherwise", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    folder.write("broken.xyz", "1 2 3\n4 5 x\n");
    const auto status = [&](const std::string& members) {
        const CommandResult result = regress_suite(folder, "{" + members + "}", "--json r.json");
        UNSCOPED_INFO(members << '\n' << result.out << result.err);
        return result.status;
    };
    const auto miss = [&] { return OrderedJson::parse(read_file(folder / "r.json"))[0]["misses"].dump(); };
    CHECK(status(R"("input": "broken.xyz", "fails": "broken\\.xyz:2: ")") == 0);
    CHECK(miss() == "[]");
    CHECK(OrderedJson::parse(read_file(folder / "r.json"))[0]["status"] == 1);
    const CommandResult again =
        regress_suite(folder, R"({"input": "broken.xyz", "fails": "broken"})", "--baseline r.json");
    CHECK_THAT(again.out, Contains("       -       -  none\n")); // there is no mesh to be another
    CHECK(status(R"("input": "none.xyz", "fails": "no such file", "status": 1)") == 0);
    CHECK(status(R"("input": "scan.xyz", "args": ["--depth", "17"], "fails": "--depth 17", "status": 2)")
          == 0);
    CHECK(status(R"("input": "scan.xyz", "args": ["--sed"], "fails": "no such option", "status": 2)") == 0);

    CHECK(status(R"("input": "scan.xyz", "args": ["--depth", "3"], "fails": "no such file")") == 1);
    CHECK_THAT(miss(), Contains("made a mesh; a failure with `no such file` was expected"));
    CHECK(status(R"("input": "broken.xyz", "fails": "no such file")") == 1);
    CHECK_THAT(miss(), Contains("failed without `no such file` in its message: ./broken.xyz:2: "));
    CHECK(status(R"("input": "broken.xyz", "fails": "broken", "status": 2)") == 1);
    CHECK_THAT(miss(), Contains("failed with status 1, expected 2: ./broken.xyz:2: "));
}

TEST_CASE("a failure that could not be missed, or is none, is refused", "[cli]") {
    const Folder folder;
    const auto refusal_of = [&](const std::string& members) {
        const CommandResult result = regress_suite(folder, R"({"input": "a.xyz", )" + members + "}");
        return result.status == 2 ? result.err : "not refused";
    };
    CHECK_THAT(refusal_of(R"("fails": "")"), Contains("case 1: `fails` is empty"));
    CHECK_THAT(refusal_of(R"("fails": "(")"), Contains("`fails` is no regular expression"));
    CHECK_THAT(refusal_of(R"("fails": 1)"), Contains("`fails` must be text"));
    CHECK_THAT(refusal_of(R"("fails": "a", "expect": {"mesh.closed": true})"),
               Contains("`fails` and `expect` are both there"));
    CHECK_THAT(refusal_of(R"("fails": "a", "status": 0)"), Contains("`status` must be 1 (it failed) or 2"));
    CHECK_THAT(refusal_of(R"("status": 1, "expect": {"mesh.closed": true})"),
               Contains("nothing that `fails`"));
    CHECK_THAT(refusal_of(R"("max_slower": 0.9, "expect": {"mesh.closed": true})"),
               Contains("`max_slower` must be a number of times the baseline, 1 or more"));
    std::string longest(600, 'a');
    CHECK_THAT(refusal_of(R"("fails": ")" + longest + "\""), Contains("`fails` is longer than 512 bytes"));
}

TEST_CASE("JUnit's XML is as the schemas of its readers have it, whatever cases are called", "[cli]") {
    if (std::system("xmllint --version >/dev/null 2>&1") != 0) {
        WARN("skipped, for there is no xmllint");
        return;
    }
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    const CommandResult result =
        regress_suite(folder,
                      closed("scan.xyz") + ',' + closed("missing.xyz", R"(]]> & \"<!--'\u0001\ud7ff\ufffe)")
                          + R"(, {"input":
            "scan.xyz", "name": "tabs\t and\n lines", "args": ["--depth", "3"], "expect": {"mesh.genus": 4}},
            {"input": "missing.xyz", "fails": "no such file"})",
                      "--junit r.xml --json base.json");
    REQUIRE(result.status == 1);
    const std::string check = "xmllint --noout --schema '" HSDM_SOURCE_DIR "/tests/cli/junit.xsd' ";
    CHECK(std::system((check + (folder / "r.xml") + " 2>/dev/null").c_str()) == 0);
    CHECK(run(folder, "regress suite.json --junit r.xml --baseline base.json --filter scan --jobs 2").status
          == 0);
    CHECK(std::system((check + (folder / "r.xml") + " 2>/dev/null").c_str()) == 0);
    CHECK_THAT(read_file(folder / "r.xml"),
               Contains(R"(<property name="against the baseline" value="0 slower)"));
}
