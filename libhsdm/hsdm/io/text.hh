#pragma once
// Text as the readers see it: lines, fields and numbers, and the place a message speaks of.

#include "hsdm/io/source_bytes.hh"

#include <fast_float/fast_float.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hsdm::io {

/// Blanks inside a line. A carriage return is one, so CRLF needs no care (see Text::newline).
inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
/// Separators that may stand between blanks and of which two in a row enclose an empty field.
inline bool is_separator(char c) {
    return c == ',' || c == ';';
}

/// Part of a source that is text.
struct Text {
    const SourceBytes* source;
    const char* origin; ///< of the source, where line 1 begins
    const char* begin;
    const char* end;
    char newline = '\n'; ///< '\r' in files that know no other line end

    /// The whole source behind its byte-order mark, if it has one.
    explicit Text(const SourceBytes& bytes) : Text(bytes, bytes.view()) {}
    /// Its head only, which may end anywhere.
    static Text head_of(const SourceBytes& bytes) { return {bytes, bytes.head()}; }

    const std::string& file() const { return source->name(); }
    std::string_view view() const { return {begin, static_cast<std::size_t>(end - begin)}; }
    /// The same text from `at` on.
    Text from(const char* at) const {
        Text rest = *this;
        rest.begin = at;
        return rest;
    }

    /// Number of the line that holds `at`, from 1, in the whole source. O(bytes before it): for messages.
    std::size_t line_of(const char* at) const;
    /// Throws Error `FILE:LINE: message`.
    [[noreturn]] void fail(const char* at, const std::string& message) const;

    /// The end of the line that holds `at`.
    const char* find_newline(const char* at) const;
    /// The line that begins at `at`, without its end; moves `at` to the next one.
    std::string_view line(const char*& at) const;
    /// Pieces of about `size` bytes that end at line ends, fixed by the text alone.
    std::vector<std::pair<const char*, const char*>> chunks(std::size_t size = std::size_t(1) << 19) const;

private:
    Text(const SourceBytes& bytes, std::string_view content);
};

/// Reads [at, exponent) with the exponent behind it, whose letter is a `d` or `D`, as Fortran writes doubles.
/// Returns the end of the exponent, or `exponent` if there is none: no digit follows the letter.
const char* parse_fortran_number(const char* at, const char* exponent, const char* end, double& value);

/// The number at the start of [at, end), as text files spell them: "1e-3", "1d-3", "+.5", "nan", "-inf",
/// "-1.#IND". Returns the end of the number, or nullptr if there is none; what follows it is the caller's to
/// judge.
inline const char* parse_number(const char* at, const char* end, double& value) {
    if (at != end && *at == '+') {
        ++at;
        if (at != end && (*at == '+' || *at == '-')) return nullptr;
    }
    const auto result = fast_float::from_chars(at, end, value);
    if (result.ec == std::errc::invalid_argument) return nullptr;
    if (result.ptr != end && (*result.ptr == 'd' || *result.ptr == 'D'))
        return parse_fortran_number(at, result.ptr, end, value);
    at = result.ptr;
    // How Microsoft's C library prints what is not finite: 1.#IND, 1.#INF, 1.#QNAN, 1.#SNAN.
    if (end - at >= 3 && at[0] == '#' && (at[1] == 'I' || at[1] == 'Q' || at[1] == 'S') && at[2] > '9') {
        value = std::numeric_limits<double>::quiet_NaN();
        for (++at; at != end && ((*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9'));) ++at;
    }
    return at;
}

/// The whole of `field` as a number, or nothing.
std::optional<double> to_number(std::string_view field);
/// The whole of `field` as a count, digits only; nothing if it does not fit.
std::optional<std::uint64_t> to_count(std::string_view field);

std::string_view trim(std::string_view text);
std::string lower(std::string_view text);
/// Behind the quotation mark that ends the field which one begins at `at`, two of them standing for one in
/// it; null if none begins there or none ends it.
const char* end_of_quotes(const char* at, const char* end);
/// The line up to a field that begins with `#` or `//`.
std::string_view without_comment(std::string_view line);
/// Fields between blanks, commas and semicolons; an empty field between two commas is one, a trailing comma
/// opens none. In quotation marks these are part of a field. The first `most` only, for lines that may be of
/// any length.
std::vector<std::string_view> fields(std::string_view line,
                                     std::size_t most = std::numeric_limits<std::size_t>::max());
/// `text` as a message quotes it: in quotation marks, printable, at most 40 characters.
std::string quoted(std::string_view text);

} // namespace hsdm::io
