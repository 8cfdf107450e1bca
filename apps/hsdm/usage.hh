#pragma once
// The command line's words: parsed, or refused in words that help.

#include "command.hh"

#include "hsdm/core/number_of.hh"

#include <optional>

namespace hsdm::command {

/// What is wrong with what the app was to parse: a word that is not known, with the nearest that is; or an
/// option,
/// `--depth 17: must ...`, as the user wrote it. The app's name is used in it.
std::string fault_of(const CLI::App& app, const CLI::ParseError& error);

/// Parses the command line, `help`, `help SUBCOMMAND` and `version` as words too. Returns the exit status if
/// that was all (help, version); nothing if a subcommand is to run. Throws UsageError, which names the
/// nearest known subcommand or option.
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

/// Checks of an option's text; what they say of it begins with it.
CLI::Validator whole_number(int least, int most, const std::string& wanted);
/// Finite and in the open interval.
CLI::Validator number_between(double least, double most, const std::string& wanted);
CLI::Validator one_of(std::vector<std::string> names);

/// The words with something between each and the next.
std::string joined(const std::vector<std::string>& words, const std::string& between = ", ");
/// The values of --format.
std::vector<std::string> mesh_format_names();

} // namespace hsdm::command
