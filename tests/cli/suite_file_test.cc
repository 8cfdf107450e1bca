#include "cli/run.hh"

#include <catch2/catch.hpp>

using namespace hsdm::test;

namespace {

/// The command's message for a suite with this text, if it refuses it.
std::string refusal(const std::string& text) {
    const Folder folder;
    folder.write("suite.json", text);
    const CommandResult result = run(folder, "regress suite.json");
    if (result.status == 2 && result.out.empty()) return result.err;
    return "not refused, the status is " + std::to_string(result.status);
}

std::string times(int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

bool contains(const std::string& text, const std::string& part) {
    UNSCOPED_INFO(text);
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("a suite that is none is refused where it goes wrong", "[cli]") {
    CHECK(contains(refusal("{\n\"cases\": [\n{]}"), "suite.json:3: is no JSON ("));
    CHECK(contains(refusal("\xff"), "suite.json:1: is no JSON ("));
    CHECK(contains(refusal("[]"), "suite.json: is no suite: an object with a list `cases` is"));
    CHECK(contains(refusal(R"({"cases": {}})"), "suite.json: is no suite"));
    CHECK(contains(refusal(R"({"root": 1, "cases": []})"), "suite.json: `root` must be text"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "expect": {"mesh.closed": true}}, 7]})"),
                   "suite.json: case 2: must be an object"));
    CHECK(contains(refusal(R"({"cases": [{"name": "a"}]})"), "suite.json: case 1: has no `input`"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "args": ["--depth", 3]}]})"),
                   "suite.json: case 1: `args` must be a list of texts"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "expect": true}]})"), "`expect` must be an object"));
    CHECK(contains(refusal(R"({"cases": [{"input": ")" + times(5000, "a") + R"("}]})"),
                   "`input` is longer than 4096 bytes"));
    CHECK(contains(refusal(R"({"cases": 1e999})"), "holds a number beyond the range of doubles"));
    for (const char* text : {"{", "[]", R"({"cases": [1]})"}) {
        const std::string message = refusal(text);
        CHECK(contains(message, "suite.json:"));
        CHECK(!contains(message, "exception"));
    }
}

TEST_CASE("a suite that checks nothing is refused", "[cli]") {
    CHECK(contains(refusal(R"({"cases": []})"), "suite.json: has no cases"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a"}]})"), "suite.json: case 1: expects nothing"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "expect": {}}]})"), "case 1: expects nothing"));
    const auto refused = [](const std::string& bounds) {
        return refusal(R"({"cases": [{"input": "a", "expect": {"mesh.faces": )" + bounds + "}}]}");
    };
    CHECK(contains(refused("{}"), "case 1: `mesh.faces` has no bound"));
    CHECK(contains(refused(R"({"tolerance": 3})"), "case 1: `mesh.faces` has no bound"));
    CHECK(contains(refused(R"({"max": 3, "relative": 1})"), "`mesh.faces` has a tolerance but no `value`"));
    CHECK(contains(refused(R"({"max": "3"})"), "`mesh.faces`: `max` must be a number"));
    CHECK(
        contains(refused(R"({"value": 3, "tolerance": -1})"), "`mesh.faces`: `tolerance` must be 0 or more"));
    CHECK(
        contains(refused(R"({"value": 3, "relative": -0.5})"), "`mesh.faces`: `relative` must be 0 or more"));
}

TEST_CASE("a misspelt key is refused by file, case and name with the nearest that is known", "[cli]") {
    const std::string expect = R"("expect": {"mesh.closed": true})";
    CHECK(contains(refusal(R"({"rot": ".", "cases": [{"input": "a", )" + expect + "}]}"),
                   "suite.json: has the key `rot`, which is not known; did you mean root?"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "arg": ["--depth", "3"], )" + expect + "}]}"),
                   "suite.json: case 1: has the key `arg`, which is not known; did you mean args?"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", )" + expect
                           + R"(}, {"input": "a", "expct": {"mesh.closed": true}}]})"),
                   "suite.json: case 2: has the key `expct`, which is not known; did you mean expect?"));
    const auto refused = [](const std::string& key) {
        return refusal(R"({"cases": [{"input": "a", "expect": {")" + key + R"(": 1}}]})");
    };
    CHECK(contains(refused("mesh.close"),
                   "case 1: expects `mesh.close`, which no report has; did you mean mesh.closed?"));
    for (const char* key : {"", ".", "mesh.", "mesh.faces.0", "a/b~c", "closed"})
        CHECK(contains(refused(key), "expects `" + std::string(key) + "`, which no report has"));
    CHECK(contains(refused(times(1000000, "a")), "which no report has; see docs/command.md"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "expect": {"mesh.faces": {"maxx": 3}}}]})"),
                   "case 1: `mesh.faces` has the key `maxx`, which is not known; did you mean max?"));
    CHECK(contains(refusal(R"({"cases": [{"input": "a", "expect": {"mesh.faces": 1, "mesh.faces": 2}}]})"),
                   "suite.json: has the key `mesh.faces` twice in one object"));
}

TEST_CASE("a suite nested very deep or of very many keys is refused and no stack or time runs out", "[cli]") {
    const std::string head = R"({"cases": [{"input": "a", "expect": )";
    CHECK(contains(refusal(head + R"({"a": )" + times(200000, "[") + times(200000, "]") + "}}]}"),
                   "nested more than 32 deep"));
    std::string keys;
    for (int i = 0; i < 100000; ++i) keys.append("\"").append(std::to_string(i)).append("\": 1, ");
    CHECK(contains(refusal(head + "{" + keys + "\"a\": 1}}]}"), "more than 1000 keys"));
}

TEST_CASE("keys that a report may have and this one has not are named", "[cli]") {
    const Folder folder;
    std::string points;
    for (int i = 0; i < 400; ++i) points += std::to_string(i % 20) + " " + std::to_string(i / 20) + " 0\n";
    folder.write("scan.xyz", points);
    for (const char* key : {"rejected.nothing", "input.first_nonfinite", "dropped.0.count",
                            "grid.leaves_per_level.x", "grid.leaves_per_level.99999999999999999999"}) {
        folder.write("suite.json",
                     std::string(R"({"cases": [{"input": "scan.xyz", "expect": {")") + key + R"(": 1}}]})");
        const CommandResult result = run(folder, "regress suite.json");
        CHECK(result.status == 1);
        CHECK(contains(result.out, std::string(key) + " is not in the report"));
    }
    folder.write("suite.json", R"({"cases": [{"input": "scan.xyz", "args": ["--depth", "3"],
                                               "expect": {"grid.leaves_per_level.0": {"min": 0}}}]})");
    CHECK(run(folder, "regress suite.json").status == 0);
}
