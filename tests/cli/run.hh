#pragma once
// Runs the built command as a user would, in a folder of its own.

#include "support/folder.hh"

namespace hsdm::test {

struct CommandResult {
    int status = -1; ///< 128 + signal if one ended it
    std::string out, err;
};

using support::Folder;
using support::read_file;

/// Through the shell, in `folder`; `arguments` may hold pipes and redirections: they follow the command's
/// name. `before` stands in front of it, e.g. `cat scan.xyz |`.
CommandResult run(const Folder& folder, const std::string& arguments, const std::string& before = "");

/// Copies the modules of the build, where others may write, into `modules` in the folder; returns what makes
/// them known, to stand before the command.
std::string with_modules(const Folder& folder);

/// Names in the folder, sorted, one per line.
std::string list(const Folder& folder);
bool exists(const std::string& path);

} // namespace hsdm::test
