#pragma once
// What --help prints.

#include "command.hh"

#include <memory>
#include <string>
#include <string_view>

namespace hsdm::command {

/// The text broken into lines of at most `width` bytes, of which all but the first begin with `indent`
/// spaces; the first is taken to begin there already. A longer word has a line of its own.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width);

/// Prints the option table, 80 columns wide; footers as they are. For App::formatter, and for the subcommands
/// that are added afterwards.
std::shared_ptr<CLI::FormatterBase> help_formatter();

} // namespace hsdm::command
