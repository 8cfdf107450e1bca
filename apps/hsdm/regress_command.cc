// hsdm regress: a list of reconstructions, each with what its report must say. The format is in
// docs/command.md.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "interrupt.hh"
#include "mesh_stages.hh"
#include "messages.hh"
#include "outcome.hh"
#include "reconstruct_arguments.hh"
#include "suite_file.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/source_bytes.hh"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <regex>
#include <utility>

namespace hsdm::command {
namespace {

struct Arguments {
    std::string suite, filter, json, junit;

    bool table_gives_way() const { return is_standard_output(json) || is_standard_output(junit); }
};

Outcome run_case(const Case& one) {
    Outcome outcome;
    outcome.name = one.name;
    const auto start = std::chrono::steady_clock::now();
    try {
        const CaseOptions asked = case_options(one.name, one.arguments);
        const std::vector<StageCall> stages = parse_stages(asked.stages);
        ReconstructOptions options = asked.reconstruct;
        options.progress = [](const char* phase, double) {
            set_phase(phase);
            return true;
        };
        set_activity(one.input.c_str(), "read");
        PointFile file = read_points(one.input, asked.read);
        const std::vector<Vec3> points = stages.empty() ? std::vector<Vec3>() : file.cloud.positions;
        Reconstruction result = reconstruct(std::move(file.cloud), options);
        run_stages(one.input, stages, points, false, result);
        result.report.input.file = one.input;
        result.report.input.dropped_nonfinite += file.nonfinite;
        outcome.report = Json::parse(to_json(result.report));
        for (const auto& [key, expected] : one.expect.items()) {
            const std::string reason = miss(key, find_key(outcome.report, key), expected);
            if (!reason.empty()) outcome.misses.push_back(reason);
        }
    } catch (const std::exception& error) {
        outcome.misses.push_back(message_of(error));
    }
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return outcome;
}

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
    claims.reads("the suite", given.suite);
    for (const Case& one : cases) claims.reads("the input", one.input);
    if (!given.json.empty()) claims.writes("--json " + given.json, given.json);
    if (!given.junit.empty()) claims.writes("--junit " + given.junit, given.junit);
    if (!given.table_gives_way()) claims.writes("the table", "-");
    claims.check();
    for (const std::string* path : {&given.json, &given.junit})
        if (!path->empty()) check_writable(*path);
}

/// Resets the activity, which keeps pointers, to the suite's path before the cases are freed.
struct SuiteAgain {
    const std::string& path;
    ~SuiteAgain() { set_activity(path.c_str(), current_phase()); }
};

/// A suite that cannot be read is an input that failed; one that says nothing sensible is wrong usage.
std::vector<Case> read_suite(const std::string& path) {
    const io::SourceBytes text = io::SourceBytes::open(path);
    try {
        return parse_suite(std::string(text.view()), path);
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

/// Runs the cases, prints a row for each and writes the results, on a signal those that there are. Returns
/// how many are within tolerance.
std::size_t run_cases(const std::vector<Case>& cases, const Arguments& given, std::ostream& out) {
    std::size_t width = 4, within = 0;
    for (const Case& one : cases) width = std::max(width, printable(one.name).size());
    out << "      " << std::left << std::setw(static_cast<int>(width)) << "case" << std::right
        << "     faces  closed  genus   error %  seconds" << std::endl;
    std::vector<Outcome> outcomes;
    LastWork on_signal([&cases, &outcomes, files = with_files_alone(given)] {
        if (outcomes.size() < cases.size())
            outcomes.push_back({cases[outcomes.size()].name, nullptr, {"interrupted"}, 0, true});
        write_results(files, outcomes);
    });
    for (const Case& one : cases) {
        const Outcome outcome = run_case(one);
        within += outcome.misses.empty();
        {
            const auto held = on_signal.lock();
            outcomes.push_back(outcome);
        }
        print_row(out, outcome, static_cast<int>(width)); // may wait for a reader, so without the lock
    }
    write_results(given, outcomes);
    return within;
}

int run_regress(const Arguments& given) {
    set_activity(given.suite.c_str(), "read");
    std::vector<Case> cases = read_suite(given.suite);
    const SuiteAgain again{given.suite};
    check_claims(given, cases);
    const std::size_t left_out = leave_out(cases, given);
    std::ostream& out = given.table_gives_way() ? std::cerr : std::cout;
    const std::size_t within = run_cases(cases, given, out);
    out << within << " of " << cases.size() << " within tolerance";
    if (left_out > 0) out << ", " << left_out << " left out by --filter";
    out << '\n';
    return within == cases.size() ? done : failed;
}

} // namespace

void add_regress(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("regress", "reconstruct a list of clouds and check the reports");
    const auto given = std::make_shared<Arguments>();
    sub->add_option("suite", given->suite, "a JSON file: root, cases [{name, input, args, expect}]")
        ->required();
    sub->add_option("--filter", given->filter, "run the cases in whose names this is found")
        ->type_name("REGEX");
    sub->add_option("--json", given->json, "write the reports and what missed here")->type_name("FILE");
    sub->add_option("--junit", given->junit, "write what missed here, as JUnit's XML")->type_name("FILE");
    sub->footer(
        "A case: {\"name\": \"part\", \"input\": \"part.ply\", \"args\": [\"--depth\", \"5\"],\n"
        "         \"expect\": {\"mesh.closed\": true, \"mesh.faces\": {\"value\": 300, \"tolerance\": 10},\n"
        "                    \"error.normalised_max\": {\"max\": 0.02}}}\n"
        "Exit status 1 if any case is out of tolerance, 2 if the suite is not as described.");
    sub->callback([&run, given] { run = [given] { return run_regress(*given); }; });
}

} // namespace hsdm::command
