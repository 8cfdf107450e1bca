#include "hsdm/io/json_text.hh"

#include <nlohmann/json.hpp>

namespace hsdm {
namespace {

/// Numbers and strings as nlohmann's library writes them; a single value is destroyed without allocating.
template <class Value>
void append(std::string& text, const Value& value) {
    text += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

void JsonText::break_line() {
    text_ += '\n';
    text_.append(2 * open_.size(), ' ');
}

/// Writes the separator, line end and indentation before a value or a key.
void JsonText::start_value() {
    if (after_key_) {
        after_key_ = false;
        return;
    }
    if (open_.empty()) return;
    if (!empty_) text_ += ',';
    break_line();
    empty_ = false;
}

void JsonText::open(char bracket) {
    start_value();
    text_ += bracket;
    open_ += bracket;
    empty_ = true;
}

void JsonText::end() {
    const char bracket = open_.back();
    open_.pop_back();
    if (!empty_) break_line();
    text_ += bracket == '{' ? '}' : ']';
    empty_ = false;
}

void JsonText::key(std::string_view name) {
    start_value();
    append(text_, std::string(name));
    text_ += ": ";
    after_key_ = true;
}

void JsonText::value(std::string_view text) {
    start_value();
    append(text_, std::string(text));
}

template <class Number>
requires std::is_arithmetic_v<Number>
void JsonText::value(Number number) {
    start_value();
    append(text_, number);
}
template void JsonText::value(bool);
template void JsonText::value(int);
template void JsonText::value(unsigned);
template void JsonText::value(std::int64_t);
template void JsonText::value(std::uint64_t);
template void JsonText::value(double);

void JsonText::document(std::string_view text) {
    start_value();
    if (text.ends_with('\n')) text.remove_suffix(1);
    for (const char c : text) {
        if (c == '\n')
            break_line();
        else
            text_ += c;
    }
}

} // namespace hsdm
