#include "suite_file.hh"

#include "case_report.hh"
#include "messages.hh"

#include "hsdm/core/number_of.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/write_mesh.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>

namespace hsdm::command {
namespace {

/// Deeper than any suite; what prints and compares JSON goes as deep on the stack.
constexpr int most_nested = 32;
/// More than any case expects: finding a key takes the time of all before it.
constexpr std::size_t most_keys = 1000;
/// As long as paths can be; names are matched by a recursion over their bytes.
constexpr std::size_t most_bytes = 4096;
/// Of a regular expression, which is read by recursion, too.
constexpr std::size_t most_pattern_bytes = 512;

/// A value of a suite and where it stands, for messages.
struct Place {
    const std::string& path;
    std::string in; ///< "case 3: ", or empty

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(path, in + message + "; see docs/command.md");
    }

    /// For a key that is none of those known; names the nearest.
    [[noreturn]] void fail_at(const std::string& key, const std::string& message,
                              const std::vector<std::string>& known) const {
        const std::string near = suggestion(key, known);
        if (near.empty()) fail(message);
        throw Error(path, in + message + near);
    }

    void check_keys(const Json& object, const std::vector<std::string>& known,
                    const std::string& of = "") const {
        for (const auto& [key, value] : object.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                fail_at(key, of + "has the key `" + key + "`, which is not known", known);
    }
};

Json parse_json(const std::string& text, const std::string& path) {
    std::array<std::set<std::string>, most_nested + 2> keys; // of the object that is open at each depth
    const auto check = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > most_nested)
            throw Error(path, "is nested more than " + std::to_string(most_nested)
                                  + " deep, which no suite is; see docs/command.md");
        const auto level = static_cast<std::size_t>(depth);
        if (event == Json::parse_event_t::object_start) keys[level + 1].clear();
        if (event != Json::parse_event_t::key) return true;
        const auto key = parsed.get<std::string>();
        if (!keys[level].insert(key).second)
            throw Error(path, "has the key `" + key + "` twice in one object; leave one out");
        if (keys[level].size() > most_keys)
            throw Error(path, "has an object of more than " + std::to_string(most_keys)
                                  + " keys, which no suite has; see docs/command.md");
        return true;
    };
    try {
        return Json::parse(text, check);
    } catch (const Json::parse_error& error) {
        const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
        const std::string what = error.what(), mark = " - "; // behind it stands what was wrong
        const std::size_t reason = what.find(mark);
        throw Error(path, static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1,
                    "is no JSON"
                        + (reason == std::string::npos ? "" : " (" + what.substr(reason + mark.size()) + ")")
                        + "; correct it");
    } catch (const Json::out_of_range&) {
        throw Error(path, "holds a number beyond the range of doubles; correct it");
    }
}

const Json* member(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

/// A member that is text, or the fallback where there is none.
std::string text_of(const Json& object, const char* key, const std::string& fallback, const Place& place) {
    const Json* const value = member(object, key);
    if (!value) return fallback;
    if (!value->is_string()) place.fail("`" + std::string(key) + "` must be text");
    auto text = value->get<std::string>();
    if (text.size() > most_bytes)
        place.fail("`" + std::string(key) + "` is longer than " + std::to_string(most_bytes) + " bytes");
    return text;
}

/// False for a key that no report has. What is in lists and counts by stage shows only when a report is
/// there.
bool may_lead_somewhere(const std::string& dotted) {
    std::size_t end = 0;
    do {
        end = dotted.find('.', end + 1);
        const Json* const part = find_key(model_report(), dotted.substr(0, end));
        if (!part) return false;
        if (part->is_array() || (part->is_object() && part->empty())) return true;
    } while (end != std::string::npos);
    return true;
}

std::vector<std::string> report_keys() {
    std::vector<std::string> keys;
    for (const auto& [group, value] : model_report().items()) {
        keys.push_back(group);
        if (!value.is_object()) continue;
        for (const auto& [key, inner] : value.items()) keys.push_back(group + '.' + key);
    }
    return keys;
}

/// Refuses what could never be missed as well as what could never hold.
void check_expectations(const Json& expect, const Place& place) {
    if (expect.empty())
        place.fail("expects nothing: `expect` must name a key of the report, or `fails` a message");
    for (const auto& [key, expected] : expect.items()) {
        const std::string quoted = '`' + key + '`';
        if (!may_lead_somewhere(key))
            place.fail_at(key, "expects " + quoted + ", which no report has", report_keys());
        if (!expected.is_object()) continue;
        place.check_keys(expected, {"min", "max", "value", "tolerance", "relative"}, quoted + ' ');
        for (const auto& [bound, limit] : expected.items())
            if (!limit.is_number()) place.fail(quoted + ": `" + bound + "` must be a number");
        for (const char* slack : {"tolerance", "relative"})
            if (expected.contains(slack) && expected[slack] < 0)
                place.fail(quoted + ": `" + slack + "` must be 0 or more, nothing is within less");
        if (!expected.contains("min") && !expected.contains("max") && !expected.contains("value"))
            place.fail(quoted + " has no bound: `min`, `max` or `value`");
        if (!expected.contains("value") && (expected.contains("tolerance") || expected.contains("relative")))
            place.fail(quoted + " has a tolerance but no `value`");
    }
}

/// Whether a key is, or leads into, an object of the report.
bool is_of(const std::string& key, const std::string& object) {
    return key == object || key.starts_with(object + '.');
}

/// A true surface that nothing is expected of is as good as none; and without one, or without a file that is
/// written, nothing can be expected of it.
void check_extras(const Case& one, const Place& place) {
    const auto expected = [&one](const char* object) {
        for (const auto& [key, value] : one.expect.items())
            if (is_of(key, object)) return true;
        return false;
    };
    if (one.reference.empty() && expected("reference"))
        place.fail("expects something of a `reference`, but names none");
    if (!one.reference.empty() && !expected("reference"))
        place.fail("names a `reference`, but expects nothing of it, such as `reference.hausdorff`");
    if (one.output.empty() && expected("output"))
        place.fail("expects something of an `output`, but names no format");
}

/// Of the case's `output`; empty if it has none.
std::string output_format(const Json& entry, const Place& place) {
    std::vector<std::string> known;
    for (const MeshFormatInfo& info : mesh_formats())
        if (info.is_read) known.emplace_back(info.name);
    std::string words = known.front();
    for (std::size_t i = 1; i < known.size(); ++i) words += (i + 1 < known.size() ? ", " : " or ") + known[i];
    std::string format = text_of(entry, "output", "", place);
    if (entry.contains("output") && std::find(known.begin(), known.end(), format) == known.end())
        place.fail_at(format, "`output` must be " + words, known);
    return format;
}

/// What the message of a failure must hold.
std::string failure_pattern(const Json& entry, const Place& place) {
    std::string pattern = text_of(entry, "fails", "", place);
    if (pattern.empty()) place.fail("`fails` is empty, so any message would do; name a part of the message");
    if (pattern.size() > most_pattern_bytes)
        place.fail("`fails` is longer than " + std::to_string(most_pattern_bytes) + " bytes");
    try {
        const std::regex check(pattern);
    } catch (const std::regex_error&) {
        place.fail("`fails` is no regular expression (ECMAScript)");
    }
    return pattern;
}

/// How the case must fail, if it must: nothing can be expected of a report then.
std::optional<Failure> parse_failure(const Json& entry, const Place& place) {
    if (!entry.contains("fails")) {
        if (entry.contains("status")) place.fail("has a `status`, but nothing that `fails`");
        return std::nullopt;
    }
    for (const char* key : {"expect", "reference", "output", "max_slower", "max_memory"})
        if (entry.contains(key))
            place.fail("`fails` and `" + std::string(key) + "` are both there, but what fails has no report");
    Failure failure{failure_pattern(entry, place)};
    if (const Json* const status = member(entry, "status")) {
        if (*status != 1 && *status != 2) place.fail("`status` must be 1 (it failed) or 2 (wrong usage)");
        failure.status = status->get<int>();
    }
    return failure;
}

/// A bound relative to the baseline, if there is one.
std::optional<double> parse_ratio(const Json& entry, const char* key, const Place& place) {
    const Json* const ratio = member(entry, key);
    if (!ratio) return std::nullopt;
    if (!ratio->is_number() || *ratio < 1)
        place.fail("`" + std::string(key) + "` must be a number of times the baseline, 1 or more");
    return ratio->get<double>();
}

Case parse_case(const Json& entry, const std::filesystem::path& folder, OtherKeys others,
                const Place& place) {
    if (!entry.is_object()) place.fail("must be an object with an `input`");
    if (others == OtherKeys::refused)
        place.check_keys(entry, {"name", "input", "args", "reference", "output", "expect", "fails", "status",
                                 "max_slower", "max_memory"});
    const std::string input = text_of(entry, "input", "", place);
    if (input.empty()) place.fail("has no `input`");
    Case one;
    one.input = (folder / input).string();
    one.pattern = input;
    one.folder = folder.string();
    one.name = text_of(entry, "name", input, place);
    one.named = entry.contains("name");
    if (const Json* const arguments = member(entry, "args")) {
        const bool words = arguments->is_array()
                           && std::all_of(arguments->begin(), arguments->end(),
                                          [](const Json& word) { return word.is_string(); });
        if (!words) place.fail("`args` must be a list of texts");
        one.arguments = arguments->get<std::vector<std::string>>();
    }
    const Json* const expect = member(entry, "expect");
    one.expect = expect ? *expect : Json::object();
    if (!one.expect.is_object()) place.fail("`expect` must be an object");
    if (others == OtherKeys::left) return one;
    one.fails = parse_failure(entry, place);
    one.most_slower = parse_ratio(entry, "max_slower", place);
    one.most_memory = parse_ratio(entry, "max_memory", place);
    if (!one.fails) check_expectations(one.expect, place);
    if (const std::string reference = text_of(entry, "reference", "", place); !reference.empty())
        one.reference = (folder / reference).string();
    one.output = output_format(entry, place);
    check_extras(one, place);
    return one;
}

/// The element of an array that digits name.
const Json* element(const Json& array, std::string_view digits) {
    const auto index = number_of<std::size_t>(digits);
    return index && *index < array.size() ? &array[*index] : nullptr;
}

} // namespace

std::vector<Case> parse_suite(const std::string& text, const std::string& path, OtherKeys others) {
    const Json suite = parse_json(text, path);
    const Place place{path, ""};
    const Json* const entries = suite.is_object() ? member(suite, "cases") : nullptr;
    if (!entries || !entries->is_array()) place.fail("is no suite: an object with a list `cases` is");
    if (others == OtherKeys::refused) place.check_keys(suite, {"root", "cases"});
    const auto folder = std::filesystem::path(path).parent_path() / text_of(suite, "root", ".", place);
    if (entries->empty()) place.fail("has no cases, so it would check nothing");
    std::vector<Case> cases;
    for (const Json& entry : *entries) {
        cases.push_back(
            parse_case(entry, folder, others, {path, "case " + std::to_string(cases.size() + 1) + ": "}));
        cases.back().index = cases.size() - 1;
    }
    return cases;
}

const Json* find_key(const Json& report, const std::string& dotted) {
    const Json* at = &report;
    for (std::size_t begin = 0; at && begin <= dotted.size();) {
        const std::size_t end = std::min(dotted.find('.', begin), dotted.size());
        const std::string key = dotted.substr(begin, end - begin);
        at = at->is_object() ? member(*at, key.c_str()) : at->is_array() ? element(*at, key) : nullptr;
        begin = end + 1;
    }
    return at;
}

std::string miss(const std::string& key, const Json* value, const Json& expected) {
    if (value == nullptr) return key + " is not in the report";
    const std::string found = key + " is " + value->dump();
    if (!expected.is_object()) return *value == expected ? "" : found + ", expected " + expected.dump();
    if (!value->is_number() && !value->is_array()) return found + ", a number was expected";
    const double x = value->is_array() ? static_cast<double>(value->size()) : value->get<double>();
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

} // namespace hsdm::command
