#include "hsdm/io/text.hh"

#include "hsdm/core/number_of.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <cstring>

namespace hsdm::io {

Text::Text(const SourceBytes& bytes, std::string_view content)
    : source(&bytes), origin(content.data()), begin(origin), end(origin + content.size()) {
    if (content.starts_with("\xef\xbb\xbf")) begin += 3;
    if (view().find('\n') == std::string_view::npos && view().find('\r') != std::string_view::npos)
        newline = '\r';
}

std::size_t Text::line_of(const char* at) const {
    const auto ends = static_cast<std::size_t>(std::count(origin, at, newline));
    // An error at the end of the file is blamed on the last line, not on the empty one after it.
    const bool behind_last = at == end && ends > 0 && at[-1] == newline;
    return behind_last ? ends : ends + 1;
}

void Text::fail(const char* at, const std::string& message) const {
    throw Error(file(), line_of(at), message);
}

const char* Text::find_newline(const char* at) const {
    const void* found = at == end ? nullptr : std::memchr(at, newline, static_cast<std::size_t>(end - at));
    return found ? static_cast<const char*>(found) : end;
}

std::string_view Text::line(const char*& at) const {
    const char* first = at;
    const char* last = find_newline(at);
    at = last == end ? end : last + 1;
    return {first, static_cast<std::size_t>(last - first)};
}

std::vector<std::pair<const char*, const char*>> Text::chunks(std::size_t size) const {
    std::vector<std::pair<const char*, const char*>> pieces;
    for (const char* at = begin; at != end;) {
        const char* last = end;
        if (static_cast<std::size_t>(end - at) > size) {
            last = find_newline(at + size);
            if (last != end) ++last;
        }
        pieces.emplace_back(at, last);
        at = last;
    }
    return pieces;
}

const char* parse_fortran_number(const char* at, const char* exponent, const char* end, double& value) {
    const char* digits = exponent + 1;
    if (digits != end && (*digits == '+' || *digits == '-')) ++digits;
    const char* last = digits;
    while (last != end && *last >= '0' && *last <= '9') ++last;
    // Behind another exponent, or behind `nan`, the letter is no exponent either.
    const bool plain =
        std::all_of(at, exponent, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
    if (last == digits || !plain) return exponent;
    std::string number(at, last);
    number[static_cast<std::size_t>(exponent - at)] = 'e';
    fast_float::from_chars(number.data(), number.data() + number.size(), value);
    return last;
}

std::optional<double> to_number(std::string_view field) {
    double value;
    const char* end = field.data() + field.size();
    if (parse_number(field.data(), end, value) != end) return std::nullopt;
    return value;
}

std::optional<std::uint64_t> to_count(std::string_view field) {
    return number_of<std::uint64_t>(field);
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

const char* end_of_quotes(const char* at, const char* end) {
    if (at == end || *at != '"') return nullptr;
    while ((at = std::find(at + 1, end, '"')) != end) {
        if (at + 1 == end || at[1] != '"') return at + 1;
        ++at;
    }
    return nullptr;
}

std::string_view without_comment(std::string_view line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool starts_field = i == 0 || is_blank(line[i - 1]) || is_separator(line[i - 1]);
        const char* const quotes =
            starts_field ? end_of_quotes(line.data() + i, line.data() + line.size()) : nullptr;
        if (quotes)
            i = static_cast<std::size_t>(quotes - line.data()) - 1;
        else if (starts_field && (line[i] == '#' || line.substr(i, 2) == "//"))
            return line.substr(0, i);
    }
    return line;
}

std::vector<std::string_view> fields(std::string_view line, std::size_t most) {
    std::vector<std::string_view> found;
    for (line = trim(line); !line.empty() && found.size() < most; line = trim(line)) {
        const char* const quotes = end_of_quotes(line.data(), line.data() + line.size());
        std::size_t length = quotes ? static_cast<std::size_t>(quotes - line.data()) : 0;
        while (length < line.size() && !is_blank(line[length]) && !is_separator(line[length])) ++length;
        found.push_back(line.substr(0, length));
        line = trim(line.substr(length));
        if (!line.empty() && is_separator(line.front())) line.remove_prefix(1);
    }
    return found;
}

std::string quoted(std::string_view text) {
    const bool long_text = text.size() > 40;
    std::string result = "\"";
    for (char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
    return result + (long_text ? "...\"" : "\"");
}

} // namespace hsdm::io
