#pragma once
// What a name to write to stands for.

#include <string>

namespace hsdm {

struct OutputTarget {
    enum class Kind {
        file,       ///< a regular file, or nothing yet: can be replaced as a whole
        stream,     ///< a pipe or device, which takes bytes as they come
        descriptor, ///< open in this process: "-", /dev/stdout, /dev/fd/N and links to them
    };
    Kind kind = Kind::file;
    std::string path;    ///< symbolic links followed, dangling ones too
    int descriptor = -1; ///< of the last kind
};

/// Throws Error for an empty name and a loop of links.
OutputTarget find_target(const std::string& path);

/// Throws Error, which names `path`, for a target of kind `file` that must not be replaced: a folder, a
/// write-protected file.
void check_replaceable(const std::string& path, const OutputTarget& target);

/// Throws Error for what AtomicFile could not write: a folder, a write-protected file, a missing folder or
/// one that this user may not write to. Opens nothing; a disk may still be full later.
void check_writable(const std::string& path);

/// "standard output" for "-", else the name: for messages.
std::string spoken_name(const std::string& path);

} // namespace hsdm
