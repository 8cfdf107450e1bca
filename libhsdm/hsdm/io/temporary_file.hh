#pragma once
// Temporary files beside their targets, `.NAME.PID-N.tmp`, locked while their process lives.

#include <filesystem>
#include <string>
#include <vector>

namespace hsdm {

struct TemporaryFile {
    std::string path;    ///< empty: none could be made, and errno says why
    int descriptor = -1; ///< for reading and writing; the lock lasts until it is closed
};

/// A new one, in the registry; `mode` as of open(2).
TemporaryFile make_temporary(const std::filesystem::path& target, unsigned mode);

/// Removes the temporaries of this target that no process has locked: those that a killed run left. A folder
/// is read once per process: O(its entries) then, O(log) for further targets. Returns their paths. On a file
/// system without locks nothing is removed; where locks do not reach other machines, no two of them must
/// write the same target at a time.
std::vector<std::string> remove_leftovers(const std::filesystem::path& target);

} // namespace hsdm
