// hsdm regress: a list of reconstructions, each with what its report must say. The format is in
// docs/command.md.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "messages.hh"
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
#include <optional>

namespace hsdm::command {
namespace {

struct Outcome {
    Json report;
    std::vector<std::string> misses;
    double seconds = 0;
};

Outcome run_case(const Case& one) {
    Outcome outcome;
    const auto start = std::chrono::steady_clock::now();
    try {
        ReadOptions read;
        ReconstructOptions options = case_options(one.name, one.arguments, read);
        options.progress = [](const char* phase, double) {
            set_phase(phase);
            return true;
        };
        set_activity(one.input.c_str(), "read");
        PointFile file = read_points(one.input, read);
        Reconstruction result = reconstruct(std::move(file.cloud), options);
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

void print_row(std::ostream& out, const Case& one, const Outcome& outcome, int width) {
    const auto count = [&outcome](const char* key) {
        const Json* const value = outcome.report.is_null() ? nullptr : find_key(outcome.report, key);
        return value == nullptr ? std::string("-") : value->dump();
    };
    const Json* const error =
        outcome.report.is_null() ? nullptr : find_key(outcome.report, "error.normalised_max");
    std::ostringstream percent;
    if (error != nullptr) percent << std::setprecision(3) << 100 * error->get<double>();
    out << (outcome.misses.empty() ? "ok    " : "MISS  ") << std::left << std::setw(width)
        << printable(one.name) << std::right << std::setw(10) << count("mesh.faces") << std::setw(8)
        << count("mesh.closed") << std::setw(7) << count("mesh.genus") << std::setw(10) << percent.str()
        << std::setw(9) << std::fixed << std::setprecision(2) << outcome.seconds << std::defaultfloat << '\n';
    for (const std::string& reason : outcome.misses) out << "      " << printable(reason) << '\n';
    out << std::flush;
}

/// Throws UsageError for a result that would destroy the suite or a cloud, Error for one that cannot be
/// written.
void check_claims(const std::string& path, const std::vector<Case>& cases, const std::string& json_path) {
    FileClaims claims;
    claims.reads("the suite", path);
    for (const Case& one : cases) claims.reads("the input", one.input);
    if (!json_path.empty()) claims.writes("--json " + json_path, json_path);
    if (!is_standard_output(json_path)) claims.writes("the table", "-");
    claims.check();
    if (!json_path.empty()) check_writable(json_path);
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

int run_regress(const std::string& path, const std::string& json_path) {
    set_activity(path.c_str(), "read");
    const std::vector<Case> cases = read_suite(path);
    const SuiteAgain again{path};
    check_claims(path, cases, json_path);
    std::ostream& out = is_standard_output(json_path) ? std::cerr : std::cout;
    std::size_t width = 4;
    for (const Case& one : cases) width = std::max(width, printable(one.name).size());
    out << "      " << std::left << std::setw(static_cast<int>(width)) << "case" << std::right
        << "     faces  closed  genus   error %  seconds\n";
    Json results = Json::array();
    std::size_t missed = 0;
    for (const Case& one : cases) {
        const Outcome outcome = run_case(one);
        missed += !outcome.misses.empty();
        print_row(out, one, outcome, static_cast<int>(width));
        results.push_back({{"name", one.name},
                           {"ok", outcome.misses.empty()},
                           {"misses", outcome.misses},
                           {"seconds", outcome.seconds},
                           {"report", outcome.report}});
    }
    out << cases.size() - missed << " of " << cases.size() << " within tolerance\n";
    set_activity(json_path.c_str(), "write");
    if (!json_path.empty())
        write_text(json_path, results.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
    return missed == 0 ? done : failed;
}

} // namespace

void add_regress(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("regress", "reconstruct a list of clouds and check the reports");
    const auto suite = std::make_shared<std::string>();
    const auto json = std::make_shared<std::string>();
    sub->add_option("suite", *suite, "a JSON file: root, cases [{name, input, args, expect}]")->required();
    sub->add_option("--json", *json, "write the reports and what missed here")->type_name("FILE");
    sub->footer(
        "A case: {\"name\": \"part\", \"input\": \"part.ply\", \"args\": [\"--depth\", \"5\"],\n"
        "         \"expect\": {\"mesh.closed\": true, \"mesh.faces\": {\"value\": 300, \"tolerance\": 10},\n"
        "                    \"error.normalised_max\": {\"max\": 0.02}}}\n"
        "Exit status 1 if any case is out of tolerance, 2 if the suite is not as described.");
    sub->callback([&run, suite, json] { run = [suite, json] { return run_regress(*suite, *json); }; });
}

} // namespace hsdm::command
