#pragma once
// Texts as pages hold them.

#include "embedded.hh"

#include <string>
#include <string_view>

namespace hsdm::command {

/// The text in HTML or XML, between tags and in quoted attributes: what is not printable is written out by
/// printable(), and so are U+FFFE and U+FFFF, which are UTF-8 but no characters of XML.
std::string html_text(std::string_view text);
/// The same line by line, so that line ends stay.
std::string html_lines(const std::string& text);

/// Bytes in the 64 characters of RFC 4648, and back; what is no such text gives none.
std::string base64(std::string_view bytes);
std::string from_base64(const std::string& text);

/// The parts of an embedded file, one after the other.
std::string whole_text(embedded::Text text);

} // namespace hsdm::command
