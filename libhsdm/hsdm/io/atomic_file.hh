#pragma once
// A file that is written completely or not at all.

#include "hsdm/io/output_target.hh"

#include <cstdint>
#include <string>
#include <string_view>

namespace hsdm::os {
struct FileStatus;
}

namespace hsdm {

/// Collects output in a temporary file beside the target; commit() puts it in the target's place. Without
/// commit() the destructor removes the temporary and the target stays what it was.
///
/// - An existing target keeps its mode, and its owner and group where this process may give them; one that is
///   write-protected is refused. Symbolic links are followed: the file that they name is replaced or made.
/// - A target with several hard links keeps them: once the temporary is whole, its bytes are copied into the
///   target. Space is set aside before; should the copying fail all the same, the temporary stays, and the
///   Error names it. Readers may see this copy half done.
/// - "-", /dev/stdout, /dev/fd/N, pipes and devices are written directly and cannot be taken back.
/// - Temporaries of the same target that a killed run left are removed (see remove_leftovers), and named by
///   take_removed_leftovers().
class AtomicFile {
public:
    /// Throws Error if the target cannot be written. Waits for the reader of a named pipe.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Throws Error, e.g. when the disk is full.
    void write(std::string_view bytes);
    /// Whether bytes can be written out of their order.
    bool seeks() const { return !temporary_.empty(); }
    /// Where it seeks. Not to be mixed with write(), which goes on where it was. Throws Error.
    void write_at(std::uint64_t offset, std::string_view bytes);
    /// Where other processes may write what this one does not; empty for what is written directly.
    const std::string& shared_name() const { return temporary_; }
    /// Throws Error unless the temporary has so many bytes: others have written all that they should.
    void check_size(std::uint64_t bytes) const;
    /// Flushes to the disk and puts the file in place; throws Error. To be called once, last.
    void commit();

private:
    [[noreturn]] void fail(const std::string& what) const;
    void open_temporary();
    void open_directly();
    void take_over_mode(const os::FileStatus& old) const;
    void copy_into_target();
    void forget_temporary(bool unlink) noexcept;

    std::string path_; // as the user gave it, for messages
    OutputTarget target_;
    std::string temporary_; // empty when written directly, and in the end
    int descriptor_ = -1;
};

} // namespace hsdm
