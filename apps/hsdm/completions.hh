#pragma once
// What shells offer when Tab is pressed: scripts for bash, zsh and fish.

#include "option_table.hh"

namespace hsdm::command {

/// Of the whole command. They need nothing but the shell: bash no bash-completion, and none runs the command.
std::string bash_completion(const CommandText& command);
std::string zsh_completion(const CommandText& command);
std::string fish_completion(const CommandText& command);

} // namespace hsdm::command
