#pragma once
// A file that is there completely or not at all.

#include <string>
#include <string_view>

namespace hsdm {

/// Collects output in a temporary file beside the target; commit() puts it in the target's place. Without
/// commit() the destructor removes the temporary and the target stays what it was. "-" is standard output,
/// and a target that is no regular file (a pipe, /dev/null) is written directly.
class AtomicFile {
public:
    /// Throws Error if the target is a directory or its folder cannot be written.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Throws Error, e.g. when the disk is full.
    void write(std::string_view bytes);
    /// Flushes to the disk and renames; throws Error. To be called once, last.
    void commit();

    /// Name of the temporary, for a writer that insists on opening its file itself.
    const std::string& temporary() const { return temporary_; }

private:
    [[noreturn]] void fail(const std::string& what) const;

    std::string path_;      // as the user gave it, for messages
    std::string target_;    // what is replaced: path_ with links followed
    std::string temporary_; // empty when written directly
    int descriptor_ = -1;
};

} // namespace hsdm
