#include "hsdm/io/cursor.hh"

#include <algorithm>
#include <cmath>

namespace hsdm::io {

bool Cursor::is_continuation() const {
    if (*at_ != '\\') return false;
    const char* next = at_ + 1;
    while (next != text_->end && *next == '\r' && *next != text_->newline) ++next;
    return next != text_->end && *next == text_->newline;
}

bool Cursor::find_in_line() {
    while (at_ != text_->end && *at_ != text_->newline) {
        if (is_continuation())
            skip_line();
        else if (is_blank(*at_))
            ++at_;
        else
            return *at_ != '#';
    }
    return false;
}

void Cursor::skip_line() {
    at_ = text_->find_newline(at_);
    if (at_ != text_->end) ++at_;
}

bool Cursor::find_next() {
    while (!find_in_line()) {
        if (at_ == text_->end) return false;
        skip_line();
    }
    return true;
}

std::string_view Cursor::field() {
    const char* begin = at_;
    while (at_ != text_->end && *at_ != text_->newline && !is_blank(*at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
}

double Cursor::number(const char* what) {
    double value = 0;
    const char* end = parse_number(at_, text_->end, value);
    if (end && (end == text_->end || *end == text_->newline || is_blank(*end) || *end == '#')) {
        at_ = end;
        return value;
    }
    const char* begin = at_;
    fail(begin, io::quoted(field()) + " stands where " + what + " should be; correct the line");
}

double Cursor::number_in_line(const char* what) {
    if (!find_in_line())
        fail(at_, std::string("the line ends where ") + what + " should be; correct the line");
    return number(what);
}

std::int64_t Cursor::integer_in_line(const char* what) {
    const bool found = find_in_line();
    const char* begin = at_;
    const double value = found ? number(what) : number_in_line(what);
    constexpr double most = 9e15; // up to here every whole number is a double
    if (value != std::floor(value) || std::abs(value) > most)
        fail(begin, io::quoted({begin, static_cast<std::size_t>(at_ - begin)}) + " stands where " + what
                        + ", a whole number, should be; correct the line");
    return static_cast<std::int64_t>(value);
}

} // namespace hsdm::io
