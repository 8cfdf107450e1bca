#include "input_pattern.hh"

#include "messages.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace hsdm::command {
namespace {

namespace fs = std::filesystem;

/// Bytes of the UTF-8 character that the text begins with; of what is none, one.
std::size_t length_of_character(std::string_view text) {
    std::size_t length = 1;
    while (length < text.size() && length < 4 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80)
        ++length;
    return length;
}

/// A class `[...]` that the pattern begins with.
struct Bracket {
    std::size_t length = 0; ///< of the pattern; 0: it begins with none, the bracket is itself
    bool holds = false;     ///< the character is of the class
};

Bracket bracket_of(std::string_view pattern, std::string_view character) {
    const bool inverse = pattern.size() > 1 && pattern[1] == '!';
    std::size_t at = inverse ? 2 : 1;
    const std::size_t end = pattern.find(']', at + 1); // the first character of a class may be `]`
    if (end == std::string_view::npos) return {};
    bool found = false;
    while (at < end) {
        const std::string_view low = pattern.substr(at, length_of_character(pattern.substr(at)));
        at += low.size();
        std::string_view high = low;
        if (at + 1 < end && pattern[at] == '-') {
            high = pattern.substr(at + 1, length_of_character(pattern.substr(at + 1)));
            at += 1 + high.size();
        }
        found = found || (low <= character && character <= high); // the order of UTF-8 is that of Unicode
    }
    return {end + 1, found != inverse};
}

/// Length of what the pattern begins with, if the name's first character is so; 0 if it is not.
std::size_t step(std::string_view pattern, std::string_view character) {
    if (pattern.front() == '?') return 1;
    if (pattern.front() == '[') {
        const Bracket bracket = bracket_of(pattern, character);
        if (bracket.length > 0) return bracket.holds ? bracket.length : 0;
    }
    return pattern.starts_with(character) ? character.size() : 0;
}

bool is_pattern(std::string_view text) {
    return text.find_first_of("*?[") != std::string_view::npos;
}

/// Names in a folder that match, in the folder's own order; those of `**` are folders.
std::vector<fs::path> entries(const fs::path& folder, std::string_view pattern) {
    std::vector<fs::path> found;
    os::for_each_name(folder.empty() ? "." : folder.string(), [&](const char* name) {
        if (matches(pattern, name)) found.push_back(folder / name);
    });
    return found;
}

bool is_folder(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path.empty() ? fs::path(".") : path, error);
}

/// The folder and all below it but hidden ones, links left out.
std::vector<fs::path> folders_below(const fs::path& folder) {
    std::vector<fs::path> all{folder};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const fs::path from = all[i];
        for (const fs::path& inner : entries(from, "*")) {
            std::error_code error;
            if (is_folder(inner) && !fs::is_symlink(inner, error)) all.push_back(inner);
        }
    }
    return all;
}

/// What the pattern's next part makes of the paths so far.
std::vector<fs::path> follow(const std::vector<fs::path>& paths, const std::string& part) {
    std::vector<fs::path> next;
    for (const fs::path& path : paths) {
        if (part == "**") {
            const auto below = folders_below(path);
            next.insert(next.end(), below.begin(), below.end());
        } else if (is_pattern(part)) {
            const auto found = entries(path, part);
            next.insert(next.end(), found.begin(), found.end());
        } else {
            next.push_back(path / part);
        }
    }
    return next;
}

} // namespace

bool matches(std::string_view pattern, std::string_view name) {
    if (name.starts_with('.') && !pattern.starts_with('.')) return false;
    std::string_view after_star; // where the last `*` can be made to hold one more character
    std::string_view name_then;
    bool starred = false;
    while (!name.empty()) {
        if (pattern.starts_with('*')) {
            pattern.remove_prefix(1);
            after_star = pattern;
            name_then = name;
            starred = true;
            continue;
        }
        const std::string_view character = name.substr(0, length_of_character(name));
        if (const std::size_t taken = pattern.empty() ? 0 : step(pattern, character); taken > 0) {
            pattern.remove_prefix(taken);
            name.remove_prefix(character.size());
        } else if (starred) {
            name_then.remove_prefix(length_of_character(name_then));
            name = name_then;
            pattern = after_star;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*') == std::string_view::npos;
}

std::vector<std::string> files_of(const std::string& folder, const std::string& pattern) {
    const fs::path whole(pattern);
    std::vector<fs::path> paths{whole.is_absolute() ? whole.root_path() : fs::path(folder)};
    for (const fs::path& part : whole.relative_path())
        if (!part.empty()) paths = follow(paths, part.string());
    std::vector<std::string> files;
    for (const fs::path& path : paths) {
        std::error_code error;
        if (!fs::exists(path, error) || is_folder(path)) continue;
        files.push_back(whole.is_absolute() ? path.string() : path.lexically_relative(folder).string());
    }
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return files;
}

std::vector<Case> with_files_of_patterns(std::vector<Case> cases, const std::string& path) {
    std::vector<Case> all;
    for (Case& one : cases) {
        std::error_code error;
        if (!is_pattern(one.pattern) || fs::exists(one.input, error)) {
            all.push_back(std::move(one));
            continue;
        }
        const std::vector<std::string> files = files_of(one.folder, one.pattern);
        if (files.empty())
            throw Error(path, "case " + std::to_string(one.index + 1)
                                  + ": no file is as `input` says: " + one.input + "; correct the pattern");
        for (const std::string& file : files) {
            all.push_back(one);
            all.back().input = (fs::path(one.folder) / file).string();
            const std::string shown = printable(file); // results are UTF-8, file names need not be
            all.back().name = one.named ? one.name + ": " + shown : shown;
        }
    }
    return all;
}

} // namespace hsdm::command
