#pragma once
// A file that several ranks write, each at places of its own.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace hsdm {

/// Of all ranks, which call the same functions in the same order. One that is not closed, since a rank has
/// failed, is let go of without waiting for others.
class SharedFile {
public:
    SharedFile() = default;
    virtual ~SharedFile() = default;
    SharedFile(const SharedFile&) = delete;
    SharedFile& operator=(const SharedFile&) = delete;

    /// Writes this rank's bytes, maybe none, by itself. Returns why they cannot be written, or "".
    virtual std::string write_at(std::uint64_t offset, std::string_view bytes) = 0;
    /// Returns once the disk has what this rank wrote, or why it does not. Waits for all others, which must
    /// call it, too: only once no rank has failed.
    virtual std::string close() = 0;
};

/// An existing file, by positioned writes of this process; null if it cannot be written.
std::unique_ptr<SharedFile> open_positioned(const std::string& path);

} // namespace hsdm
