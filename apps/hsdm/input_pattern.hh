#pragma once
// Inputs of a suite that stand for many files: `scans/*.ply`.

#include "suite_file.hh"

#include <string>
#include <string_view>
#include <vector>

namespace hsdm::command {

/// True if the name of a file or folder is as the pattern says: `*` is any text, `?` one character, `[a-z]`
/// one of these and `[!a-z]` none of them; all else is itself. What begins with a dot matches only a pattern
/// that does. O(pattern * name), no recursion.
bool matches(std::string_view pattern, std::string_view name);

/// The files below `folder` that the pattern names, as paths from there, sorted by their bytes; between
/// slashes, `**` stands for any number of folders. Links to folders are followed, but not by `**`. Folders
/// that may not be read hold none.
std::vector<std::string> files_of(const std::string& folder, const std::string& pattern);

/// The cases, each whose input is a pattern and no file's name replaced by one for each file: named by the
/// file, after the case's own name if it has one. Throws Error, which begins with `path`, for a pattern that
/// no file is as, since such a case would check nothing.
std::vector<Case> with_files_of_patterns(std::vector<Case> cases, const std::string& path);

} // namespace hsdm::command
