// hsdm regress against an earlier run, each case in a process of its own, and the page of a suite.
#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>

using namespace hsdm;
using namespace hsdm::test;

namespace {

using OrderedJson = nlohmann::ordered_json;
using Catch::Matchers::Contains;

/// Two cases of one scan, and their results as a baseline that a test may change.
class BaselineFolder : public Folder {
public:
    explicit BaselineFolder(const std::string& members = "", std::size_t points = 1000) {
        write("scan.xyz", xyz(sphere_scan(points)));
        const std::string rest = R"("input": "scan.xyz", "args": ["--depth", ")"
                                 + std::string(points > 10000 ? "6" : "3")
                                 + R"("], "expect": {"mesh.closed": true})";
        write("suite.json", R"({"cases": [{"name": "first", )" + rest + R"(}, {"name": "second", )" + rest
                                + members + "}]}");
        const CommandResult result = run(*this, "regress suite.json --json base.json");
        INFO(result.out << result.err);
        REQUIRE(result.status == 0);
        baseline = OrderedJson::parse(read_file(*this / "base.json"));
    }

    CommandResult against(const std::string& arguments) const {
        write("base.json", baseline.dump());
        return run(*this, "regress suite.json --baseline base.json --json r.json " + arguments);
    }
    OrderedJson results() const { return OrderedJson::parse(read_file(*this / "r.json")); }

    OrderedJson baseline;
};

const std::string no_floor = "--least-seconds 0 ";

std::string times_found(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return std::to_string(count);
}

/// A program that draws pages without a screen, or nothing.
std::string browser() {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
        if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0) return name;
    return "";
}

} // namespace

TEST_CASE("a case slower than the baseline lets it be is a miss, after it ran as often as it may", "[cli]") {
    BaselineFolder folder;
    CHECK(folder.against("--max-slower 1000").status == 0);
    CHECK(folder.results()[0]["runs"] == 1);
    folder.baseline[1]["seconds"] = 1e-6;
    const CommandResult missed = folder.against(no_floor + "--max-slower 1.5 --runs 2 --filter second");
    CHECK(missed.status == 1);
    CHECK_THAT(missed.out, Contains(" s, in the best of 2 runs")
                               && Contains("the baseline 0.000 s; at most "
                                           "1.50 times that expected")
                               && Contains("1 slower"));
    CHECK(folder.results()[0]["runs"] == 2);
    CHECK(folder.results()[0]["baseline"]["slower"] == true);
    // Less than the floor more is no difference.
    CHECK(folder.against("--least-seconds 1000 --max-slower 1.5").status == 0);
    CHECK(folder.against(no_floor).status == 0); // nothing was asked for
}

TEST_CASE("a machine that is slower than the baseline's was is allowed for", "[cli]") {
    BaselineFolder folder;
    for (OrderedJson& one : folder.baseline) {
        one["seconds"] = one["seconds"].get<double>() / 20;
        one["machine_seconds"] = one["machine_seconds"].get<double>() / 1000;
    }
    CHECK(folder.against(no_floor + "--max-slower 1.5").status == 0);
    CHECK(folder.results()[0]["baseline"]["machine"] > 20);
    for (OrderedJson& one : folder.baseline) one["machine_seconds"] = 1000; // a faster one asks for no more
    CHECK(folder.against(no_floor + "--max-slower 1.5 --runs 1").status == 1);
    CHECK(folder.results()[0]["baseline"]["machine"] == 1);
}

TEST_CASE("a case that takes more memory than the baseline lets it take is a miss", "[cli]") {
#if defined(HSDM_SANITIZED)
    BaselineFolder folder; // a sanitizer's own memory is enough
#else
    BaselineFolder folder("", 60000);
#endif
    CHECK(folder.against("--max-memory 3 --filter first").status == 0);
    for (OrderedJson& one : folder.baseline) {
        CHECK(one["peak_memory_bytes"] > 20000000);
        one["peak_memory_bytes"] = 1000000;
    }
    const CommandResult missed = folder.against("--max-memory 1.2 --runs 1");
    CHECK(missed.status == 1);
    CHECK_THAT(missed.out, Contains("the baseline 1 MB; at most 1.20 times that expected")
                               && Contains("2 with more memory"));
}

TEST_CASE(
    "a case may have bounds of its own, and a run without the baseline says that they were not looked at",
    "[cli]") {
    BaselineFolder folder(R"(, "max_slower": 1e9, "max_memory": 1e9)");
    for (OrderedJson& one : folder.baseline) one["seconds"] = 1e-6;
    CHECK(folder.against(no_floor + "--max-slower 1.5 --runs 1").status == 1);
    CHECK(folder.results()[0]["ok"] == false);
    CHECK(folder.results()[1]["ok"] == true);
    CHECK_THAT(run(folder, "regress suite.json").out,
               Contains("1 with bounds of a baseline that was not given"));
}

TEST_CASE("what cannot be compared with the baseline is not judged, and the last line says why", "[cli]") {
    BaselineFolder folder;
    for (OrderedJson& one : folder.baseline) one["seconds"] = 1e-6;
    const auto last_line = [&](const std::string& part) {
        const CommandResult result = folder.against(no_floor + "--max-slower 1.5");
        INFO(result.out << result.err);
        CHECK(result.status == 0);
        CHECK_THAT(result.out, Contains(part));
    };
    const OrderedJson kept = folder.baseline;
    for (OrderedJson& one : folder.baseline) one["report"]["threads"] = 1000;
    last_line("2 not judged (threads: 1000 in the baseline, ");
    folder.baseline = kept;
    for (OrderedJson& one : folder.baseline) one["args"] = {"--depth", "4"};
    last_line("2 not judged (other arguments in the baseline)");
    folder.baseline = kept;
    for (OrderedJson& one : folder.baseline) one["report"] = nullptr;
    last_line("2 not judged (no mesh in the baseline)");
    folder.baseline = kept;
    for (OrderedJson& one : folder.baseline) one["name"] = "before";
    last_line("2 new, 2 gone (before, ...)");
    folder.baseline = kept;
    for (OrderedJson& one : folder.baseline) {
        one["seconds"] = 1000;
        one["report"]["mesh"]["digest"] = "0123456789abcdef";
    }
    last_line("2 with another mesh");
    // One of an older command, with less in it.
    folder.baseline = OrderedJson::parse(R"([{"name": "first", "ok": true, "seconds": 1000, "report": {}}])");
    last_line("1 with another mesh, 1 new");
}

TEST_CASE("a baseline that is none is refused, and bounds without one", "[cli]") {
    BaselineFolder folder;
    for (const char* text : {"", "{", "{}", "[]", "[1]"}) {
        INFO(text);
        folder.write("base.json", text);
        const CommandResult result = run(folder, "regress suite.json --baseline base.json");
        CHECK(result.status == 1);
        CHECK_THAT(result.err, Contains("hsdm: base.json: is no baseline"));
    }
    CHECK(run(folder, "regress suite.json --baseline none.json").status == 1);
    CHECK(run(folder, "regress suite.json --max-slower 1.3").status == 2);
    CHECK(run(folder, "regress suite.json --max-memory 1.3").status == 2);
    CHECK(run(folder, "regress suite.json --baseline base.json --max-slower 0.5").status == 2);
    CHECK(run(folder, "regress suite.json --baseline base.json --json base.json").status == 2);
    CHECK(run(folder, "regress suite.json --html scan.xyz").status == 2);
}

#if !defined(HSDM_SANITIZED) // whose memory hides that of the clouds
TEST_CASE("a case's memory is its own, whatever ran before it", "[cli]") {
    const Folder folder;
    folder.write("large.xyz", xyz(sphere_scan(60000)));
    folder.write("small.xyz", xyz(sphere_scan(500)));
    folder.write("suite.json", R"({"cases": [
        {"input": "large.xyz", "args": ["--depth", "6"], "expect": {"mesh.closed": true}},
        {"input": "small.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": true}}]})");
    const CommandResult result = run(folder, "regress suite.json --json r.json");
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    const OrderedJson results = OrderedJson::parse(read_file(folder / "r.json"));
    CHECK(2 * results[1]["peak_memory_bytes"].get<double>() < results[0]["peak_memory_bytes"].get<double>());
}
#endif

TEST_CASE("the option by which cases are run is of no use to others", "[cli]") {
    const Folder folder;
    folder.write("suite.json", "{}");
    for (const char* pipes : {"77:78", "a", ":", "''"}) {
        const CommandResult result = run(folder, std::string("regress suite.json --case ") + pipes);
        CHECK(result.status == 2);
    }
    CHECK(run(folder, "regress --help").out.find("--case ") == std::string::npos);
}

TEST_CASE("the page of a suite is whole in itself and says what missed and what changed", "[cli]") {
    BaselineFolder folder;
    folder.baseline[0]["report"]["mesh"]["digest"] = "0123456789abcdef";
    folder.baseline[0]["report"]["mesh"]["faces"] = 77777;
    const std::string suite = read_file(folder / "suite.json");
    folder.write("suite.json",
                 suite.substr(0, suite.rfind("]")) + R"(, {"name": "<b onclick='x'>&\"</script>",
        "input": "http://missing.xyz", "expect": {"mesh.closed": true}},
        {"input": "missing.xyz", "fails": "no such file"}]})");
    const CommandResult result = folder.against("--html page.html");
    CHECK(result.status == 1);
    const std::string page = read_file(folder / "page.html");
    CHECK_THAT(page, Contains("3 of 4 as they must be") && Contains("77777") && Contains("0123456789abcdef")
                         && Contains("&lt;b onclick=&#39;x&#39;&gt;&amp;&quot;&lt;/script&gt;")
                         && Contains("It failed as it must, with status 1: ./missing.xyz: no such file"));
    CHECK(page.find("<b onclick") == std::string::npos);
    CHECK(times_found(page, "</script>") == "1");
    CHECK(times_found(page, "src=\"data:image/png;base64,iVBORw0KGgo") == "2");
    for (const char* loading : {"src=\"http", "href=\"http", "url(", "@import", "fetch(", "<link", "<iframe"})
        CHECK(page.find(loading) == std::string::npos);
    CHECK_THAT(page, Contains("default-src 'none'"));
    CHECK(times_found(page, "<tr class=\"case") == "4");
    CHECK(times_found(page, "<tr class=\"case missed") == "1");
    CHECK(times_found(page, "<figcaption>now</figcaption>") == "1");
    // The pictures are in the results too, so that the next page can show them.
    CHECK(folder.results()[0]["picture"].get<std::string>().starts_with("iVBORw0KGgo"));
    folder.baseline = folder.results();
    folder.baseline[0]["report"]["mesh"]["digest"] = "0123456789abcdef";
    folder.against("--html page.html");
    CHECK(times_found(read_file(folder / "page.html"), "<figcaption>baseline</figcaption>") == "1");
}

TEST_CASE("a browser runs the page's script without a complaint, filters and sorts", "[cli]") {
    const std::string program = browser();
    if (program.empty()) {
        WARN("skipped, for there is no chromium");
        return;
    }
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    folder.write("suite.json", R"({"cases": [
        {"name": "coarse", "input": "scan.xyz", "args": ["--depth", "2"], "expect": {"mesh.closed": true}},
        {"name": "fine", "input": "scan.xyz", "args": ["--depth", "4"], "expect": {"mesh.genus": 3}}]})");
    run(folder, "regress suite.json --html page.html");
    // A script after the page's own does what a user would, and leaves what it finds in the title.
    std::string page = read_file(folder / "page.html");
    page.replace(page.rfind("</body>"), 0, R"(<script>
        const names = () => Array.from(document.querySelectorAll('tr.case:not([hidden]) summary'), s => s.textContent);
        const press = key => document.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));
        const found = [names().join()];
        press('m'); found.push(names().join()); press('a');
        const faces = Array.from(document.querySelectorAll('thead button')).find(b => b.textContent === 'faces');
        faces.click(); faces.click(); found.push(names().join());
        document.getElementById('filter').value = 'COARSE';
        document.getElementById('filter').dispatchEvent(new Event('input')); found.push(names().join());
        document.title = found.join(' | ');
        </script>)");
    folder.write("page.html", page);
    const CommandResult result = run(
        folder, "--version >/dev/null; " + program
                    + " --headless --no-sandbox --disable-gpu --user-data-dir=profile --dump-dom page.html "
                      "2>/dev/null | grep -o '<title>.*</title>'");
    CHECK(result.out == "<title>coarse,fine | fine | fine,coarse | coarse</title>\n");
}
