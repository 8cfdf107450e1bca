#include "suite_file.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace hsdm::command {
namespace {

/// Deeper than any suite; what prints and compares JSON goes as deep on the stack.
constexpr int deepest = 32;
/// More than any case expects: finding a key takes the time of all before it.
constexpr std::size_t most_keys = 1000;

/// A value of a suite and where it stands, for messages.
struct Place {
    const std::string& path;
    std::string in; ///< "case 3: ", or empty

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(path, in + message + "; see docs/command.md");
    }
};

Json parse_json(const std::string& text, const std::string& path) {
    std::array<std::size_t, deepest + 2> keys{}; // of the object that is open at each depth
    const auto limit = [&](int depth, Json::parse_event_t event, Json&) {
        if (depth > deepest)
            throw Error(path, "is nested more than " + std::to_string(deepest)
                                  + " deep, which no suite is; see docs/command.md");
        const auto level = static_cast<std::size_t>(depth);
        if (event == Json::parse_event_t::object_start) keys[level + 1] = 0;
        if (event == Json::parse_event_t::key && ++keys[level] > most_keys)
            throw Error(path, "has an object of more than " + std::to_string(most_keys)
                                  + " keys, which no suite has; see docs/command.md");
        return true;
    };
    try {
        return Json::parse(text, limit);
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
    return value->get<std::string>();
}

Case parse_case(const Json& entry, const std::filesystem::path& folder, const Place& place) {
    if (!entry.is_object()) place.fail("must be an object with an `input`");
    const std::string input = text_of(entry, "input", "", place);
    if (input.empty()) place.fail("has no `input`");
    Case one;
    one.input = (folder / input).string();
    one.name = text_of(entry, "name", input, place);
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
    return one;
}

/// The element of an array that digits name.
const Json* element(const Json& array, std::string_view digits) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const bool known = error == std::errc() && end == digits.data() + digits.size() && index < array.size();
    return known ? &array[index] : nullptr;
}

} // namespace

std::vector<Case> parse_suite(const std::string& text, const std::string& path) {
    const Json suite = parse_json(text, path);
    const Place place{path, ""};
    const Json* const entries = suite.is_object() ? member(suite, "cases") : nullptr;
    if (!entries || !entries->is_array()) place.fail("is no suite: an object with a list `cases` is");
    const auto folder = std::filesystem::path(path).parent_path() / text_of(suite, "root", ".", place);
    std::vector<Case> cases;
    for (const Json& entry : *entries)
        cases.push_back(parse_case(entry, folder, {path, "case " + std::to_string(cases.size() + 1) + ": "}));
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

} // namespace hsdm::command
