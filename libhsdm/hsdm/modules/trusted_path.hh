#pragma once
// Whether a file holds what this user, or the administrator, put there: asked before its code is run.

#include "hsdm/core/system.hh"

#include <cstdint>
#include <string>

namespace hsdm {

/// Why others than `user` and root could change this file or folder: what the system says of it. Empty if
/// they could not. `above`: a folder farther up, in which the sticky bit keeps others from replacing what is
/// not theirs.
std::string distrust(const os::FileStatus& status, std::uint32_t user, bool above);

/// Why others than the process's user and root could have put this file or folder there: it, the folder it is
/// named in, or one above these can be written by them or is theirs; links are followed. Empty if they could
/// not, or if it does not exist.
std::string distrust(const std::string& path);

} // namespace hsdm
