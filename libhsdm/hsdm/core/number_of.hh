#pragma once
// Text that is a number and nothing else.

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace hsdm {

/// The number that the whole text is, as std::from_chars reads it; nothing if it is none or does not fit.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

} // namespace hsdm
