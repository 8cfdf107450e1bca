#pragma once
// The command line as data: what --help, the manual pages and the shells' completions are all made of.

#include "command.hh"

#include <string>
#include <vector>

namespace hsdm::command {

/// What a shell offers for a value.
enum class Offer { nothing, words, files, folders };

/// An option, or an argument, which has a value alone.
struct OptionText {
    std::vector<std::string> names; ///< "-o", "--output"
    std::string value;              ///< "FILE", "auto|basic|extended"; empty for a flag
    Offer offer = Offer::nothing;
    std::vector<std::string> words; ///< to offer
    std::string description;
    std::string fallback; ///< what holds where it is not given; empty: the description says it, or nothing is
    bool required = false, repeats = false;
    std::vector<std::string> excludes; ///< names of options that it cannot stand beside
};

struct OptionGroup {
    std::string title;
    std::vector<OptionText> options;
};

struct CommandText {
    std::string name; ///< "reconstruct"
    std::string path; ///< "hsdm reconstruct"
    std::string group, description;
    std::string footer; ///< lines as they are shown
    std::vector<OptionText> arguments;
    std::vector<OptionGroup> groups;      ///< --help and --version in the last one
    std::vector<CommandText> subcommands; ///< but those that are hidden
};

/// The command, or one of its subcommands, as it stands.
CommandText command_text(const CLI::App& app);

/// `[OPTION...] INPUT...`, what follows the command's name.
std::string synopsis(const CommandText& command);

/// "the mesh; ... (default: auto; not with --depth)": the description and what follows from the rest.
std::string full_description(const OptionText& option);

/// A variable of the environment that the command reads, or a status that it ends with.
struct Meaning {
    std::string name, text;
};
const std::vector<Meaning>& environment_variables();
const std::vector<Meaning>& exit_statuses();

} // namespace hsdm::command
