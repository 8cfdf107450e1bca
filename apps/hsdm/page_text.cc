#include "page_text.hh"

#include "messages.hh"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <sstream>
#include <utility>

namespace hsdm::command {
namespace {

constexpr std::string_view digits_of_64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

} // namespace

std::string html_text(std::string_view text) {
    constexpr std::pair<std::string_view, std::string_view> written[] = {{"&", "&amp;"},
                                                                         {"<", "&lt;"},
                                                                         {">", "&gt;"},
                                                                         {"\"", "&quot;"},
                                                                         {"'", "&#39;"},
                                                                         {"\xef\xbf\xbe", "\\ufffe"},
                                                                         {"\xef\xbf\xbf", "\\uffff"}};
    const std::string shown = printable(text);
    std::string result;
    for (std::string_view rest = shown; !rest.empty();) {
        const auto found =
            std::ranges::find_if(written, [rest](const auto& one) { return rest.starts_with(one.first); });
        const bool stays = found == std::end(written);
        result += stays ? rest.substr(0, 1) : found->second;
        rest.remove_prefix(stays ? 1 : found->first.size());
    }
    return result;
}

std::string html_lines(const std::string& text) {
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line);) result += html_text(line) + '\n';
    return result;
}

std::string base64(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? digits_of_64[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string from_base64(const std::string& text) {
    std::string bytes;
    if (text.size() % 4 != 0) return bytes;
    std::uint32_t word = 0;
    std::size_t held = 0;
    for (const char c : text.substr(0, text.find('='))) {
        const std::size_t digit = digits_of_64.find(c);
        if (digit == std::string_view::npos) return "";
        word = word << 6 | static_cast<std::uint32_t>(digit);
        if ((held += 6) < 8) continue;
        held -= 8;
        bytes += static_cast<char>(word >> held & 255);
    }
    return bytes;
}

std::string whole_text(embedded::Text text) {
    std::string whole;
    for (const std::string_view part : text) whole += part;
    return whole;
}

} // namespace hsdm::command
