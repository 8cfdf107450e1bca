// hsdm regress: a list of reconstructions, each with what its report must say. The format is in
// docs/command.md.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "interrupt.hh"
#include "messages.hh"
#include "outcome.hh"
#include "suite_file.hh"
#include "suite_run.hh"
#include "suite_update.hh"
#include "threads.hh"
#include "usage.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/source_bytes.hh"
#include "hsdm/io/write_mesh.hh"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <regex>
#include <utility>

namespace hsdm::command {
namespace {

struct Arguments {
    std::string suite, filter, json, junit;
    int jobs = 1;
    bool update = false;

    bool table_gives_way() const { return is_standard_output(json) || is_standard_output(junit); }
};

void print_row(std::ostream& out, const Outcome& outcome, int width) {
    const auto count = [&outcome](const char* key) {
        const Json* const value = outcome.report.is_null() ? nullptr : find_key(outcome.report, key);
        return value == nullptr ? std::string("-") : value->dump();
    };
    const Json* const error =
        outcome.report.is_null() ? nullptr : find_key(outcome.report, "error.normalised_max");
    std::ostringstream percent;
    if (error != nullptr) percent << std::setprecision(3) << 100 * error->get<double>();
    out << (outcome.misses.empty() ? "ok    " : "MISS  ") << std::left << std::setw(width)
        << printable(outcome.name) << std::right << std::setw(10) << count("mesh.faces") << std::setw(8)
        << count("mesh.closed") << std::setw(7) << count("mesh.genus") << std::setw(10) << percent.str()
        << std::setw(9) << std::fixed << std::setprecision(2) << outcome.seconds << std::defaultfloat << '\n';
    for (const std::string& reason : outcome.misses) out << "      " << printable(reason) << '\n';
    out << std::flush;
}

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
    if (!given.json.empty()) claims.writes("--json " + given.json, given.json);
    if (!given.junit.empty()) claims.writes("--junit " + given.junit, given.junit);
    if (!given.table_gives_way()) claims.writes("the table", "-");
    claims.check();
    for (const std::string* path : {&given.json, &given.junit})
        if (!path->empty()) check_writable(*path);
    if (given.update) check_writable(given.suite);
}

/// Resets the activity, which keeps pointers, to the suite's path before the cases are freed.
struct SuiteAgain {
    const std::string& path;
    ~SuiteAgain() { set_activity(path.c_str(), current_phase()); }
};

std::string text_of(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    return std::string(bytes.view());
}

/// A suite that says nothing sensible is wrong usage; one that cannot be read is an input that failed.
std::vector<Case> parse_given(const std::string& text, const std::string& path) {
    try {
        return parse_suite(text, path);
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

void write_results(const Arguments& given, const std::vector<Outcome>& outcomes) {
    const auto write = [](const std::string& path, const std::string& text) {
        set_activity(path.c_str(), "write");
        write_text(path, text);
    };
    if (!given.json.empty()) write(given.json, to_json(outcomes));
    if (!given.junit.empty()) write(given.junit, to_junit(given.suite, outcomes));
}

/// The arguments without outputs that may keep a signal waiting.
Arguments with_files_alone(Arguments given) {
    for (std::string* path : {&given.json, &given.junit})
        if (!path->empty() && find_target(*path).kind != OutputTarget::Kind::file) path->clear();
    return given;
}

/// Runs the cases, prints a row for each and writes the results, on a signal those that there are.
std::vector<Outcome> run_and_tell(const std::vector<Case>& cases, const Arguments& given, std::ostream& out) {
    std::size_t width = 4;
    for (const Case& one : cases) width = std::max(width, printable(one.name).size());
    out << "      " << std::left << std::setw(static_cast<int>(width)) << "case" << std::right
        << "     faces  closed  genus   error %  seconds" << std::endl;
    SuiteProgress progress;
    LastWork on_signal([&cases, &progress, files = with_files_alone(given)] {
        write_results(files, progress.so_far(cases));
    });
    run_cases(
        cases, given.jobs, progress,
        [&on_signal](const std::function<void()>& make) {
            const auto held = on_signal.lock();
            make();
        },
        // may wait for a reader, so without the lock
        [&out, width](const Outcome& outcome) { print_row(out, outcome, static_cast<int>(width)); });
    std::vector<Outcome> outcomes = progress.so_far(cases);
    write_results(given, outcomes);
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

int run_regress(const Arguments& given) {
    if (given.update && find_target(given.suite).kind != OutputTarget::Kind::file)
        throw UsageError("--update writes the suite anew, so it must be a file; " + given.suite + " is none");
    set_activity(given.suite.c_str(), "read");
    const std::string text = text_of(given.suite);
    std::vector<Case> cases = parse_given(text, given.suite);
    const SuiteAgain again{given.suite};
    check_claims(given, cases);
    const std::size_t left_out = leave_out(cases, given);
    std::ostream& out = given.table_gives_way() ? std::cerr : std::cout;
    const std::vector<Outcome> outcomes = run_and_tell(cases, given, out);
    const auto within =
        std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.misses.empty(); });
    out << within << " of " << cases.size() << " within tolerance";
    if (left_out > 0) out << ", " << left_out << " left out by --filter";
    out << '\n';
    const bool all_within = within == std::ssize(cases);
    if (!given.update) return all_within ? done : failed;
    const std::vector<SuiteChange> changes = changes_to(cases, outcomes);
    update_suite(given, text, changes, out);
    return all_within || mends_all(changes, cases, outcomes) ? done : failed;
}

} // namespace

void add_regress(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("regress", "reconstruct a list of clouds and check the reports");
    const auto given = std::make_shared<Arguments>();
    sub->add_option("suite", given->suite,
                    "a JSON file: root, cases [{name, input, args, reference, output, expect}]")
        ->required();
    sub->option_defaults()->group("Cases");
    sub->add_option("--filter", given->filter, "run the cases in whose names this is found (default: all)")
        ->type_name("REGEX");
    sub->option_defaults()->group("Results");
    sub->add_option("--json", given->json, "write the reports and what missed here")->type_name("FILE");
    sub->add_option("--junit", given->junit, "write what missed here, as JUnit's XML")->type_name("FILE");
    sub->option_defaults()->group("Running");
    sub->add_option("--jobs", given->jobs, "run so many cases side by side; the results are the same")
        ->check(whole_number(1, most_threads, "a whole number from 1 to 256"))
        ->type_name("N")
        ->capture_default_str();
    sub->option_defaults()->group("Results");
    sub->add_flag("--update", given->update,
                  "show which expectations change by what was found, and write the suite anew with them");
    sub->footer(
        "A case: {\"name\": \"part\", \"input\": \"part.ply\", \"args\": [\"--depth\", \"5\"],\n"
        "         \"expect\": {\"mesh.closed\": true, \"mesh.faces\": {\"value\": 300, \"tolerance\": 10},\n"
        "                    \"error.normalised_max\": {\"max\": 0.02}}}\n"
        "`reference`: a file with the true surface; `output`: off, stl, ply, obj or om, written and read "
        "back.\n"
        "Exit status 1 if any case is out of tolerance, 2 if the suite is not as described.");
    sub->callback([&run, given] { run = [given] { return run_regress(*given); }; });
}

} // namespace hsdm::command
