#include "suite_update.hh"

#include <algorithm>
#include <optional>
#include <string_view>

namespace hsdm::command {
namespace {

/// Walks over JSON that is known to be sound.
class JsonCursor {
public:
    explicit JsonCursor(std::string_view text, std::size_t at = 0) : text_(text), at_(at) {
        if (at == 0 && text.starts_with("\xef\xbb\xbf")) at_ = 3;
        skip_space();
    }

    std::size_t at() const { return at_; }

    /// Before the value of the object's member, from before the object.
    void enter(const std::string& key) {
        ++at_;
        for (;;) {
            const std::size_t begin = skip_space();
            skip_text();
            const bool found = Json::parse(text_.substr(begin, at_ - begin)).get<std::string>() == key;
            skip_space();
            ++at_; // the colon
            skip_space();
            if (found) return;
            skip_value();
            skip_space();
            ++at_; // the comma
        }
    }

    /// Before the first element of the array, from before the array.
    void enter() {
        ++at_;
        skip_space();
    }

    /// Before the next element.
    void next() {
        skip_value();
        skip_space();
        ++at_;
        skip_space();
    }

    void skip_value() {
        int depth = 0;
        do {
            const char c = text_[at_];
            if (c == '"') {
                skip_text();
            } else if (c == '{' || c == '[') {
                ++depth;
                ++at_;
            } else if (c == '}' || c == ']') {
                --depth;
                ++at_;
            } else if (depth == 0) {
                at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
            } else {
                ++at_;
            }
        } while (depth > 0);
    }

private:
    std::size_t skip_space() {
        at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
        return at_;
    }

    void skip_text() {
        for (++at_; text_[at_] != '"'; ++at_)
            if (text_[at_] == '\\') ++at_;
        ++at_;
    }

    std::string_view text_;
    std::size_t at_;
};

/// Where the value that a change is about stands in the text.
std::pair<std::size_t, std::size_t> place_of(const SuiteChange& change, const std::string& text,
                                             std::size_t of_case) {
    JsonCursor cursor(text, of_case);
    cursor.enter("expect");
    cursor.enter(change.key);
    if (!change.bound.empty()) cursor.enter(change.bound);
    const std::size_t begin = cursor.at();
    cursor.skip_value();
    return {begin, cursor.at()};
}

/// What the reports of a case hold at a key: of several files each that the case's input stands for.
using Found = std::vector<Json>;

/// Nothing if one of the reports does not have the key, or there is none. Nor of a whole object, which no
/// expectation is: its parts are.
Found found_at(const std::string& key, std::size_t index, std::span<const Case> cases,
               std::span<const Outcome> outcomes) {
    Found found;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (cases[i].index != index || outcomes[i].report.is_null()) continue;
        const Json* const value = find_key(outcomes[i].report, key);
        if (!value || value->is_object()) return {};
        found.push_back(*value);
    }
    return found;
}

bool is_missed(const std::string& key, const Found& found, const Json& expected) {
    return std::any_of(found.begin(), found.end(),
                       [&](const Json& value) { return !miss(key, &value, expected).empty(); });
}

/// What the expectation must become so that all are as it says; nothing where no one value does.
std::optional<Json> renewed(const std::string& bound, const Found& found) {
    if (bound == "min") return *std::min_element(found.begin(), found.end());
    if (bound == "max") return *std::max_element(found.begin(), found.end());
    const bool one_value = std::all_of(found.begin(), found.end(),
                                       [&found](const Json& value) { return value == found.front(); });
    return one_value ? std::optional(found.front()) : std::nullopt;
}

/// The bounds of an expectation that the numbers, or the lengths of the lists, are beyond.
void add_bounds(const SuiteChange& of, const Json& expected, Found found, std::vector<SuiteChange>& changes) {
    for (Json& value : found) {
        if (value.is_array()) value = value.size();
        if (!value.is_number()) return;
    }
    for (const char* bound : {"min", "max", "value"}) {
        const auto limit = expected.find(bound);
        if (limit == expected.end()) continue;
        Json alone{{bound, *limit}};
        for (const char* slack : {"tolerance", "relative"})
            if (std::string_view(bound) == "value" && expected.contains(slack))
                alone[slack] = expected[slack];
        if (!is_missed(of.key, found, alone)) continue;
        const std::optional<Json> after = renewed(bound, found);
        if (!after) continue;
        changes.push_back(of);
        changes.back().bound = bound;
        changes.back().before = *limit;
        changes.back().after = *after;
    }
}

/// The case's expectations with the changes made.
Json expectations_after(const Case& one, const std::vector<SuiteChange>& changes) {
    Json expect = one.expect;
    for (const SuiteChange& change : changes)
        if (change.index == one.index)
            (change.bound.empty() ? expect[change.key] : expect[change.key][change.bound]) = change.after;
    return expect;
}

std::size_t count_missed(const Json& expect, const Json& report) {
    std::size_t count = 0;
    for (const auto& [key, expected] : expect.items())
        count += !miss(key, find_key(report, key), expected).empty();
    return count;
}

} // namespace

std::vector<SuiteChange> changes_to(std::span<const Case> cases, std::span<const Outcome> outcomes) {
    std::vector<SuiteChange> changes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const Case& one = cases[i];
        if (i > 0 && cases[i - 1].index == one.index) continue; // was looked at with the first of its files
        for (const auto& [key, expected] : one.expect.items()) {
            const Found found = found_at(key, one.index, cases, outcomes);
            if (!is_missed(key, found, expected)) continue;
            SuiteChange change{one.index, one.name, key, "", expected, nullptr};
            if (expected.is_object()) {
                add_bounds(change, expected, found, changes);
            } else if (const std::optional<Json> after = renewed("", found)) {
                change.after = *after;
                changes.push_back(change);
            }
        }
    }
    return changes;
}

bool mends_all(const std::vector<SuiteChange>& changes, std::span<const Case> cases,
               std::span<const Outcome> outcomes) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const Outcome& one = outcomes[i];
        if (is_ok(one)) continue;
        if (one.report.is_null() || one.misses.size() > count_missed(cases[i].expect, one.report)
            || count_missed(expectations_after(cases[i], changes), one.report) > 0)
            return false;
    }
    return true;
}

std::string with_changes(const std::string& text, std::vector<SuiteChange> changes) {
    struct Edit {
        std::size_t begin, end;
        std::string text;
    };
    std::vector<Edit> edits;
    JsonCursor cursor(text);
    cursor.enter("cases");
    cursor.enter();
    std::stable_sort(changes.begin(), changes.end(),
                     [](const SuiteChange& a, const SuiteChange& b) { return a.index < b.index; });
    std::size_t index = 0;
    for (const SuiteChange& change : changes) {
        for (; index < change.index; ++index) cursor.next();
        const auto [begin, end] = place_of(change, text, cursor.at());
        edits.push_back({begin, end, change.after.dump()});
    }
    std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t done = 0;
    for (const Edit& edit : edits) {
        result.append(text, done, edit.begin - done).append(edit.text);
        done = edit.end;
    }
    return result.append(text, done);
}

std::string line_of(const SuiteChange& change) {
    return change.name + ": " + change.key + (change.bound.empty() ? "" : " " + change.bound) + " "
           + change.before.dump() + " -> " + change.after.dump();
}

} // namespace hsdm::command
