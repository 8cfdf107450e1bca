#include "hsdm/modules/stage_options.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace hsdm {
namespace {

/// What a kind of values is called in messages, and whether a value is one.
struct ValueKind {
    std::string_view name, wanted;
    bool (*holds)(std::string_view value);
};

/// The number that a text is; not finite if it is none.
double number_in(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc() && end == text.data() + text.size();
    return is_whole ? value : std::numeric_limits<double>::quiet_NaN();
}

bool is_count(std::string_view text) {
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value >= 0;
}

bool is_angle(std::string_view text) {
    // In radians, as it is used: the least angles are none there.
    const double radians = number_in(text) * std::numbers::pi / 180;
    return radians > 0 && radians < std::numbers::pi;
}

constexpr std::array<ValueKind, 7> value_kinds{{
    {"number", "a finite number", [](std::string_view v) { return std::isfinite(number_in(v)); }},
    {"length", "a finite number above 0",
     [](std::string_view v) { return std::isfinite(number_in(v)) && number_in(v) > 0; }},
    {"share", "a number from 0 to 1",
     [](std::string_view v) { return number_in(v) >= 0 && number_in(v) <= 1; }},
    {"count", "a whole number, 0 or more", is_count},
    {"angle", "an angle above 0 and below 180 degrees", is_angle},
    {"file", "the name of a file", [](std::string_view v) { return !v.empty() && v != "-"; }},
    {"text", "text", [](std::string_view) { return true; }},
}};

const ValueKind* find_kind(std::string_view name) {
    const auto* const found = std::find_if(value_kinds.begin(), value_kinds.end(),
                                           [&](const ValueKind& kind) { return kind.name == name; });
    return found == value_kinds.end() ? nullptr : found;
}

/// Whether the value is one of the words, which have `|` between them.
bool is_among(std::string_view words, std::string_view value) {
    const auto barred = [](std::string_view text) { return std::string(1, '|').append(text).append(1, '|'); };
    return value.find('|') == std::string_view::npos
           && barred(words).find(barred(value)) != std::string::npos;
}

/// Takes what stands before the mark, and the mark, off the text. Throws Error where there is no mark.
std::string_view take_before(std::string_view& text, std::string_view mark, std::string_view what) {
    const std::size_t end = text.find(mark);
    if (end == std::string_view::npos || end == 0)
        throw Error("its options do not read `key=value (kind): help; ...`: no " + std::string(what) + " at `"
                    + std::string(text.substr(0, 40)) + "`");
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(end + mark.size());
    return taken;
}

StageOption parse_option(std::string_view text) {
    StageOption option;
    option.key = take_before(text, "=", "key");
    option.fallback = text.substr(0, std::min(text.find(" ("), text.size()));
    text.remove_prefix(option.fallback.size());
    take_before(text, "(", "kind");
    option.kind = take_before(text, "): ", "kind");
    option.help = text;
    if (find_kind(option.kind) == nullptr && option.kind.find('|') == std::string::npos)
        throw Error("its option " + option.key + " is of the unknown kind `" + option.kind + "`");
    if (!option.fallback.empty()) check_stage_value(option.key, option.kind, option.fallback);
    return option;
}

std::string keys_of(const std::vector<StageOption>& options) {
    std::string keys;
    for (const StageOption& option : options) keys += (keys.empty() ? "" : ", ") + option.key;
    return keys;
}

} // namespace

std::vector<StageOption> parse_stage_options(std::string_view line) {
    std::vector<StageOption> options;
    while (!line.empty()) {
        const std::size_t end = line.find("; ");
        options.push_back(parse_option(line.substr(0, end)));
        line.remove_prefix(end == std::string_view::npos ? line.size() : end + 2);
    }
    return options;
}

void check_stage_value(const std::string& key, std::string_view kind, std::string_view value) {
    const ValueKind* const known = find_kind(kind);
    if (known != nullptr ? known->holds(value) : is_among(kind, value)) return;
    throw OptionError(key + " " + std::string(value) + ": must be "
                      + std::string(known != nullptr ? known->wanted : kind));
}

void check_stage_arguments(const std::string& stage, const std::vector<StageOption>& options,
                           const StageArguments& given) {
    for (auto one = given.begin(); one != given.end(); ++one) {
        const std::string &key = one->first, &value = one->second;
        const auto option = std::find_if(options.begin(), options.end(),
                                         [&key](const StageOption& known) { return known.key == key; });
        const std::string name = stage + ": " + key;
        if (option == options.end())
            throw OptionError(name + ": unknown option; "
                              + (options.empty() ? "there is none" : "known are " + keys_of(options)));
        if (std::any_of(given.begin(), one, [&key](const auto& other) { return other.first == key; }))
            throw OptionError(name + ": given twice");
        check_stage_value(name, option->kind, value);
    }
}

} // namespace hsdm
