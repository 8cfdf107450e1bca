// hsdm regress: a list of reconstructions, each with what its report must say. The format is in
// docs/command.md.

#include "activity.hh"
#include "case_process.hh"
#include "case_runner.hh"
#include "command.hh"
#include "file_claims.hh"
#include "input_pattern.hh"
#include "interrupt.hh"
#include "junit.hh"
#include "messages.hh"
#include "outcome.hh"
#include "suite_baseline.hh"
#include "suite_file.hh"
#include "suite_page.hh"
#include "suite_run.hh"
#include "suite_table.hh"
#include "suite_update.hh"
#include "threads.hh"
#include "usage.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/source_bytes.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/version.hh"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <regex>
#include <thread>
#include <utility>

namespace hsdm::command {
namespace {

struct Arguments {
    std::string suite, filter, json, junit, html, baseline;
    BaselineBounds bounds;
    int jobs = 1;
    bool update = false;
    std::string of_case; ///< the pipes, in a process that is to run one case

    bool table_gives_way() const {
        return is_standard_output(json) || is_standard_output(junit) || is_standard_output(html);
    }
};

/// What a run of the suite goes by, and what came of it.
struct SuiteRun {
    const Arguments& given;
    const std::vector<Case>& cases;
    std::optional<Baseline> baseline = std::nullopt;
    std::vector<std::string> gone = {}; ///< names of cases that only the baseline has
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

    const Baseline* before() const { return baseline ? &*baseline : nullptr; }
};

/// Throws UsageError for a result that would destroy the suite, a cloud or the other, Error for one that
/// cannot be written.
void check_claims(const Arguments& given, const std::vector<Case>& cases) {
    FileClaims claims;
    if (given.update)
        claims.writes("--update of " + given.suite, given.suite);
    else
        claims.reads("the suite", given.suite);
    for (const Case& one : cases) {
        claims.reads("the input", one.input);
        if (!one.reference.empty()) claims.reads("the reference", one.reference);
    }
    if (!given.baseline.empty()) claims.reads("the baseline", given.baseline);
    if (!given.json.empty()) claims.writes("--json " + given.json, given.json);
    if (!given.junit.empty()) claims.writes("--junit " + given.junit, given.junit);
    if (!given.html.empty()) claims.writes("--html " + given.html, given.html);
    if (!given.table_gives_way()) claims.writes("the table", "-");
    claims.check();
    for (const std::string* path : {&given.json, &given.junit, &given.html})
        if (!path->empty()) check_writable(*path);
    if (given.update) check_writable(given.suite);
}

std::string text_of(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    return std::string(bytes.view());
}

/// A suite that says nothing sensible is wrong usage; one that cannot be read is an input that failed.
std::vector<Case> parse_given(const std::string& text, const std::string& path) {
    try {
        std::vector<Case> cases = with_files_of_patterns(parse_suite(text, path), path);
        std::map<std::string, std::size_t> numbers;
        for (Case& one : cases) one.number_of_name = numbers[one.name]++;
        return cases;
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

/// Leaves out the cases whose names the filter does not match; returns their number.
std::size_t leave_out(std::vector<Case>& cases, const Arguments& given) {
    if (given.filter.empty()) return 0;
    try {
        const std::regex wanted(given.filter);
        const std::size_t left_out =
            std::erase_if(cases, [&wanted](const Case& one) { return !std::regex_search(one.name, wanted); });
        if (!cases.empty()) return left_out;
    } catch (const std::regex_error&) {
        throw UsageError("--filter " + given.filter + ": is no regular expression (ECMAScript); correct it");
    }
    throw UsageError("--filter " + given.filter + ": matches the name of no case of " + given.suite);
}

std::string junit_of(const SuiteRun& run, const std::vector<Outcome>& outcomes) {
    const auto seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - run.start);
    JunitRun words{run.given.suite, seconds.count(), {{"hsdm", version}}};
    words.properties.emplace_back("jobs", std::to_string(run.given.jobs));
    if (!run.given.filter.empty()) words.properties.emplace_back("filter", run.given.filter);
    if (run.baseline) {
        words.properties.emplace_back("baseline", run.given.baseline);
        words.properties.emplace_back("against the baseline", baseline_words(outcomes, run.gone));
    }
    return to_junit(words, outcomes);
}

void write_results(const Arguments& files, const SuiteRun& run, const std::vector<Outcome>& outcomes) {
    const auto write = [](const std::string& path, const std::string& text) {
        set_activity(path.c_str(), "write");
        write_text(path, text);
    };
    if (!files.json.empty()) write(files.json, to_json(outcomes));
    if (!files.junit.empty()) write(files.junit, junit_of(run, outcomes));
    if (!files.html.empty())
        write(files.html,
              to_html({files.suite, files.baseline, run.before(), run.cases, run.gone, outcomes}));
}

/// The arguments without outputs that may keep a signal waiting.
Arguments with_files_alone(Arguments given) {
    for (std::string* path : {&given.json, &given.junit, &given.html})
        if (!path->empty() && find_target(*path).kind != OutputTarget::Kind::file) path->clear();
    return given;
}

/// What each case's process does. Side by side they share the processors, so that no core has several threads
/// of each to do.
CaseTask task_of(const Arguments& given) {
    CaseTask task;
    if (given.jobs > 1)
        task.threads = std::max(1, (static_cast<int>(std::thread::hardware_concurrency()) + given.jobs - 1)
                                       / given.jobs);
    task.measure_machine = !given.json.empty() || !given.baseline.empty();
    task.picture = !given.html.empty();
    return task;
}

/// Runs the cases, prints a row for each and writes the results, on a signal those that there are.
std::vector<Outcome> run_and_tell(const SuiteRun& run, std::ostream& out) {
    const Arguments& given = run.given;
    SuiteTable table(out, run.cases, run.baseline.has_value());
    table.print_head();
    SuiteProgress progress;
    LastWork on_signal([&run, &progress, files = with_files_alone(given)] {
        write_results(files, run, progress.so_far(run.cases));
    });
    CaseRunner runner(task_of(given), run.before(), given.bounds);
    run_cases(
        run.cases, given.jobs, [&runner](const Case& one) { return runner.run(one); }, progress,
        [&on_signal](const std::function<void()>& make) {
            const auto held = on_signal.lock();
            make();
        },
        // may wait for a reader, so without the lock
        [&table](const Outcome& outcome) { table.print_row(outcome); });
    std::vector<Outcome> outcomes = progress.so_far(run.cases);
    write_results(given, run, outcomes);
    return outcomes;
}

/// Shows what changes in the suite, then writes it. Throws Error if somebody else changed it meanwhile.
void update_suite(const Arguments& given, const std::string& text, const std::vector<SuiteChange>& changes,
                  std::ostream& out) {
    if (changes.empty()) {
        out << "no expectation of " << printable(given.suite) << " changes\n";
        return;
    }
    for (const SuiteChange& change : changes) out << "      " << printable(line_of(change)) << '\n';
    out << std::flush;
    const std::string renewed = with_changes(text, changes);
    set_activity(given.suite.c_str(), "write");
    if (text_of(given.suite) != text)
        throw Error(given.suite, "was changed while its cases ran; it is left as it is now, run them again");
    write_text(given.suite, renewed);
    out << changes.size() << (changes.size() == 1 ? " expectation of " : " expectations of ")
        << printable(given.suite) << " renewed\n";
}

/// Throws UsageError for options that do not go together.
void check_options(const Arguments& given) {
    if (given.update && find_target(given.suite).kind != OutputTarget::Kind::file)
        throw UsageError("--update writes the suite anew, so it must be a file; " + given.suite + " is none");
    if (!given.baseline.empty()) return;
    if (given.bounds.most_slower) throw UsageError("--max-slower: of which --baseline FILE? give it, too");
    if (given.bounds.most_memory) throw UsageError("--max-memory: of which --baseline FILE? give it, too");
}

/// What was not looked at, so that nobody takes it for right.
std::string words_of_unjudged(const SuiteRun& run) {
    if (run.baseline) return "";
    const auto bound = std::count_if(run.cases.begin(), run.cases.end(), [](const Case& one) {
        return one.most_slower.has_value() || one.most_memory.has_value();
    });
    return bound == 0 ? "" : ", " + std::to_string(bound) + " with bounds of a baseline that was not given";
}

void print_last_lines(const SuiteRun& run, const std::vector<Outcome>& outcomes, std::size_t left_out,
                      std::ostream& out) {
    out << std::count_if(outcomes.begin(), outcomes.end(), is_ok) << " of " << run.cases.size()
        << " within tolerance";
    if (left_out > 0) out << ", " << left_out << " left out by --filter";
    out << words_of_unjudged(run) << '\n';
    if (run.baseline)
        out << "against " << printable(run.given.baseline) << ": " << baseline_words(outcomes, run.gone)
            << '\n';
}

int run_regress(const Arguments& given) {
    if (!given.of_case.empty()) return serve_case(given.of_case);
    check_options(given);
    set_activity(given.suite.c_str(), "read");
    const std::string text = text_of(given.suite);
    std::vector<Case> cases = parse_given(text, given.suite);
    check_claims(given, cases);
    SuiteRun run{given, cases};
    if (!given.baseline.empty()) {
        set_activity(given.baseline.c_str(), "read");
        run.baseline = Baseline::read(given.baseline);
        run.gone = run.baseline->names_without(cases);
    }
    const std::size_t left_out = leave_out(cases, given);
    std::ostream& out = given.table_gives_way() ? std::cerr : std::cout;
    const std::vector<Outcome> outcomes = run_and_tell(run, out);
    print_last_lines(run, outcomes, left_out, out);
    const bool all_within = std::all_of(outcomes.begin(), outcomes.end(), is_ok);
    if (!given.update) return all_within ? done : failed;
    const std::vector<SuiteChange> changes = changes_to(cases, outcomes);
    update_suite(given, text, changes, out);
    return all_within || mends_all(changes, cases, outcomes) ? done : failed;
}

CLI::Validator times_wanted() {
    return CLI::Validator(
        [](std::string& text) {
            const auto value = number_of<double>(text);
            return value && std::isfinite(*value) && *value >= 1 ? std::string()
                                                                 : text + ": must be a number, 1 or more";
        },
        "");
}

void add_baseline_options(CLI::App& sub, Arguments& given) {
    const std::string group = "Against an earlier run";
    sub.add_option("--baseline", given.baseline, "results of an earlier run, as --json wrote them")
        ->type_name("FILE")
        ->group(group);
    sub.add_option("--max-slower", given.bounds.most_slower,
                   "a case may take so many times the baseline's seconds, such as 1.3 (default: not judged)")
        ->check(times_wanted())
        ->type_name("TIMES")
        ->group(group);
    sub.add_option("--max-memory", given.bounds.most_memory,
                   "a case may take so many times the baseline's memory (and 16 MB), such as 1.2 (default: "
                   "not judged)")
        ->check(times_wanted())
        ->type_name("TIMES")
        ->group(group);
    sub.add_option("--least-seconds", given.bounds.least_seconds,
                   "a case is not slower that takes no more than so many seconds longer")
        ->check(number_between(-1e-300, 1e6, "be a number of seconds, 0 or more"))
        ->type_name("S")
        ->capture_default_str()
        ->group(group);
    sub.add_option("--runs", given.bounds.runs,
                   "a case beyond a bound runs so many times in all, alone; the least counts")
        ->check(whole_number(1, 100, "a whole number from 1 to 100"))
        ->type_name("N")
        ->capture_default_str()
        ->group(group);
}

} // namespace

void add_regress(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("regress", "reconstruct a list of clouds and check the reports");
    const auto given = std::make_shared<Arguments>();
    sub->add_option("suite", given->suite,
                    "a JSON file: root, cases [{name, input, args, reference, output, expect | fails}]")
        ->required();
    sub->option_defaults()->group("Cases");
    sub->add_option("--filter", given->filter, "run the cases in whose names this is found (default: all)")
        ->type_name("REGEX");
    sub->option_defaults()->group("Results");
    sub->add_option("--json", given->json, "write the reports and what missed here")->type_name("FILE");
    sub->add_option("--junit", given->junit, "write what missed here, as JUnit's XML")->type_name("FILE");
    sub->add_option("--html", given->html, "write a page to look at: pictures, what missed, what changed")
        ->type_name("FILE");
    sub->option_defaults()->group("Running");
    sub->add_option("--jobs", given->jobs, "run so many cases side by side; the results are the same")
        ->check(whole_number(1, most_threads, "a whole number from 1 to 256"))
        ->type_name("N")
        ->capture_default_str();
    sub->option_defaults()->group("Results");
    sub->add_flag("--update", given->update,
                  "show which expectations change by what was found, and write the suite anew with them");
    add_baseline_options(*sub, *given);
    sub->add_option("--case", given->of_case)->group(""); // of the processes that run a case each
    sub->footer(
        "A case: {\"name\": \"part\", \"input\": \"part.ply\", \"args\": [\"--depth\", \"5\"],\n"
        "         \"expect\": {\"mesh.closed\": true, \"mesh.faces\": {\"value\": 300, \"tolerance\": 10},\n"
        "                    \"error.normalised_max\": {\"max\": 0.02}}}\n"
        "`input` may be a pattern, scans/*.ply, with a case for each file; `fails` in the place of `expect` "
        "is a "
        "regular\nexpression of the message that it must fail with.\n"
        "`reference`: a file with the true surface; `output`: off, stl, ply, obj or om, written and read "
        "back.\n"
        "Exit status 1 if any case is out of tolerance, 2 if the suite is not as described.");
    sub->callback([&run, given] { run = [given] { return run_regress(*given); }; });
}

} // namespace hsdm::command
