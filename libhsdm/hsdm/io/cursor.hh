#pragma once
// A walk through text, number by number, that knows where it is when something is wrong.

#include "hsdm/io/text.hh"

namespace hsdm::io {

/// Walks through a text; `#` begins a comment, a backslash at the end of a line continues it.
class Cursor {
public:
    explicit Cursor(const Text& text) : text_(&text), at_(text.begin) {}

    /// Moves to the next thing that is neither blank, comment nor line end; false at the end of the text.
    bool find_next();
    /// Moves over blanks; false at the end of the line, at a comment too.
    bool find_in_line();
    /// Moves behind the end of the line.
    void skip_line();

    /// The next field: up to a blank or the line's end.
    std::string_view field();
    /// The number that begins here; fails naming `what` should be there.
    double number(const char* what);
    /// The number next in this line; fails if the line ends before.
    double number_in_line(const char* what);
    /// A whole number next in this line.
    std::int64_t integer_in_line(const char* what);

    const char* at() const { return at_; }
    std::size_t left() const { return static_cast<std::size_t>(text_->end - at_); }
    /// Throws Error `FILE:LINE: message`.
    [[noreturn]] void fail(const char* at, const std::string& message) const { text_->fail(at, message); }

private:
    bool is_continuation() const;

    const Text* text_;
    const char* at_;
};

} // namespace hsdm::io
