// hsdm regress: a list of reconstructions, each with what its report must say. The format is in
// docs/command.md.

#include "activity.hh"
#include "command.hh"
#include "file_claims.hh"
#include "messages.hh"
#include "reconstruct_arguments.hh"
#include "usage.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/output_target.hh"
#include "hsdm/io/source_bytes.hh"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <optional>

namespace hsdm::command {
namespace {

using Json = nlohmann::ordered_json;

struct Case {
    std::string name, input;
    std::vector<std::string> arguments;
    Json expect; ///< report key, with dots between levels -> what it must be
};

struct Outcome {
    Json report;
    std::vector<std::string> misses;
    double seconds = 0;
};

Json parse_suite(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    const std::string_view text = bytes.view();
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        const auto at = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
        throw Error(path, 1 + static_cast<std::size_t>(std::count(text.begin(), at, '\n')),
                    "is not JSON: what ends here cannot stand here; see docs/command.md for the format");
    }
}

/// The value of a key, or what stands for it; throws naming the key if it is of another kind.
template <class T>
T value_of(const std::string& path, const std::string& name, const Json& object, const char* key,
           const std::optional<T>& fallback, const char* wanted) {
    if (!object.contains(key) && fallback) return *fallback;
    try {
        return object.at(key).get<T>();
    } catch (const Json::exception&) {
        throw Error(path, name + ": `" + key + "` must be " + wanted + "; see docs/command.md");
    }
}

Case read_case(const std::string& path, const std::filesystem::path& folder, const Json& entry,
               std::size_t number) {
    const std::string name = "case " + std::to_string(number);
    if (!entry.is_object()) throw Error(path, name + ": must be an object; see docs/command.md");
    Case one;
    const auto input = value_of<std::string>(path, name, entry, "input", {}, "the name of a file");
    one.input = (folder / input).string();
    one.name = value_of<std::string>(path, name, entry, "name", input, "a text");
    one.arguments = value_of<std::vector<std::string>>(path, name, entry, "args", std::vector<std::string>(),
                                                       "a list of texts");
    one.expect = value_of<Json>(path, name, entry, "expect", Json::object(), "an object");
    if (!one.expect.is_object()) throw Error(path, "case " + one.name + ": expect must be an object");
    return one;
}

std::vector<Case> read_cases(const std::string& path) {
    const Json suite = parse_suite(path);
    if (!suite.is_object() || !suite.contains("cases") || !suite["cases"].is_array())
        throw Error(path, "is not a suite: it must be an object with a list `cases`; see docs/command.md");
    const auto root = value_of<std::string>(path, "the suite", suite, "root", ".", "the name of a folder");
    std::vector<Case> cases;
    for (const Json& entry : suite["cases"])
        cases.push_back(
            read_case(path, std::filesystem::path(path).parent_path() / root, entry, cases.size() + 1));
    return cases;
}

const Json* find_key(const Json& report, const std::string& dotted) {
    std::string pointer = "/";
    for (const char c : dotted) switch (c) {
        case '.':
            pointer += '/';
            break;
        case '~': // as pointers spell these two
            pointer += "~0";
            break;
        case '/':
            pointer += "~1";
            break;
        default:
            pointer += c;
        }
    const Json::json_pointer where(pointer);
    return report.contains(where) ? &report.at(where) : nullptr;
}

/// Empty if the value is as expected, else the reason. A plain value must be equal; an object holds bounds
/// `min`, `max`, or `value` with `tolerance` (absolute) or `relative`.
std::string miss(const std::string& key, const Json* value, const Json& expected) {
    if (value == nullptr) return key + " is not in the report";
    const std::string found = key + " is " + value->dump();
    if (!expected.is_object()) return *value == expected ? "" : found + ", expected " + expected.dump();
    for (const auto& [bound, limit] : expected.items()) {
        const bool known = bound == "min" || bound == "max" || bound == "value" || bound == "tolerance"
                           || bound == "relative";
        if (!known || !limit.is_number()) return key + ": `" + bound + "` is no bound; see docs/command.md";
    }
    if (!value->is_number()) return found + ", a number was expected";
    const double x = value->get<double>();
    if (expected.contains("min") && !(x >= expected["min"].get<double>()))
        return found + ", at least " + expected["min"].dump() + " expected";
    if (expected.contains("max") && !(x <= expected["max"].get<double>()))
        return found + ", at most " + expected["max"].dump() + " expected";
    if (expected.contains("value")) {
        const double target = expected["value"].get<double>();
        const double slack =
            expected.value("tolerance", 0.0) + expected.value("relative", 0.0) * std::abs(target);
        if (!(std::abs(x - target) <= slack))
            return found + ", expected " + expected["value"].dump() + " within " + Json(slack).dump();
    }
    return "";
}

/// The case's arguments through the same parser as the command line's.
ReconstructOptions options_of(const Case& one, ReadOptions& read) {
    CLI::App app("", "a case");
    ReconstructArguments arguments;
    add_method_options(app, arguments);
    add_text_options(app, arguments);
    std::vector<std::string> words(one.arguments.rbegin(), one.arguments.rend());
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        throw Error(one.name, "args: " + fault_of(app, error));
    }
    if (!arguments.levels.empty())
        throw Error(one.name, "args: --levels makes several meshes; give one --depth");
    read = arguments.read;
    try {
        return arguments.options();
    } catch (const UsageError& error) {
        throw Error(one.name, error.what());
    }
}

Outcome run_case(const Case& one) {
    Outcome outcome;
    const auto start = std::chrono::steady_clock::now();
    try {
        ReadOptions read;
        ReconstructOptions options = options_of(one, read);
        options.progress = [](const char* phase, double) {
            set_phase(phase);
            return true;
        };
        set_activity(one.input.c_str(), "read");
        PointFile file = read_points(one.input, read);
        Reconstruction result = reconstruct(std::move(file.cloud), options);
        result.report.input.file = one.input;
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
    out << (outcome.misses.empty() ? "ok    " : "MISS  ") << std::left << std::setw(width) << printable(one.name)
        << std::right << std::setw(10) << count("mesh.faces") << std::setw(8) << count("mesh.closed")
        << std::setw(7) << count("mesh.genus") << std::setw(10) << percent.str() << std::setw(9) << std::fixed
        << std::setprecision(2) << outcome.seconds << std::defaultfloat << '\n';
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

int run_regress(const std::string& path, const std::string& json_path) {
    set_activity(path.c_str(), "read");
    const std::vector<Case> cases = read_cases(path);
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
        "Exit status 1 if any case is out of tolerance.");
    sub->callback([&run, suite, json] { run = [suite, json] { return run_regress(*suite, *json); }; });
}

} // namespace hsdm::command
