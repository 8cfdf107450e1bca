#pragma once
// Texts for people: safe to print, in the command's own words, with a hint where a name is nearly right.

#include <exception>
#include <span>
#include <string>
#include <string_view>

namespace hsdm::command {

/// The text with what a terminal would act on written out, `\x0a` for a line end: control characters and
/// bytes that are not UTF-8. File names may hold them. O(bytes).
std::string printable(std::string_view text);

/// The command's message for an exception: options by their names on the command line, exceptions of the
/// standard library in our own words.
std::string words_of(const std::exception& error);

/// "; did you mean NAME?" for the known name that is nearest, or nothing if none is near.
std::string suggestion(std::string_view word, std::span<const std::string> known);

} // namespace hsdm::command
