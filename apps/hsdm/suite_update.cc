#include "suite_update.hh"

#include <algorithm>
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

/// The bounds of an expectation that the number is beyond.
void add_bounds(const SuiteChange& of, const Json& expected, const Json& found,
                std::vector<SuiteChange>& changes) {
    for (const char* bound : {"min", "max", "value"}) {
        const auto limit = expected.find(bound);
        if (limit == expected.end()) continue;
        Json alone{{bound, *limit}};
        for (const char* slack : {"tolerance", "relative"})
            if (std::string_view(bound) == "value" && expected.contains(slack))
                alone[slack] = expected[slack];
        if (miss(of.key, &found, alone).empty()) continue;
        changes.push_back(of);
        changes.back().bound = bound;
        changes.back().before = *limit;
    }
}

} // namespace

std::vector<SuiteChange> changes_to(std::span<const Case> cases, std::span<const Outcome> outcomes) {
    std::vector<SuiteChange> changes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (outcomes[i].report.is_null()) continue;
        for (const auto& [key, expected] : cases[i].expect.items()) {
            const Json* const found = find_key(outcomes[i].report, key);
            if (!found || miss(key, found, expected).empty()) continue;
            const SuiteChange change{cases[i].index, cases[i].name, key, "", expected, *found};
            if (!expected.is_object())
                changes.push_back(change);
            else if (found->is_number())
                add_bounds(change, expected, *found, changes);
            else if (found->is_array())
                add_bounds({cases[i].index, cases[i].name, key, "", expected, found->size()}, expected,
                           *found, changes);
        }
    }
    return changes;
}

bool mends_all(const std::vector<SuiteChange>& changes, std::span<const Case> cases,
               std::span<const Outcome> outcomes) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        std::size_t mended = 0;
        std::string last;
        for (const SuiteChange& change : changes) {
            if (change.index != cases[i].index || change.key == last) continue;
            last = change.key; // of several bounds the first makes the miss
            ++mended;
        }
        if (mended < outcomes[i].misses.size()) return false;
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
