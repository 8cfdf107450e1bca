#pragma once
// ZIP archives, by libzip: members read from memory, archives written to a file.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/long_text.hh"
#include "hsdm/io/source_bytes.hh"

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct zip;

namespace hsdm::io {

/// An archive to read, stored or deflated; names no file beside the source.
class ZipArchive {
public:
    /// Throws Error for what is no archive or a damaged one, and for members that together are longer than
    /// the source. The source must outlive it.
    explicit ZipArchive(const SourceBytes& bytes);

    std::size_t size() const { return names_.size(); }
    const std::string& name(std::size_t member) const { return names_[member]; }
    /// Bytes of a member, expanded; held against what its packed bytes can hold.
    std::size_t bytes_of(std::size_t member) const { return lengths_of(member).expanded; }
    /// The first `most` bytes of a member; all, and their checksum, if it has no more. Throws Error.
    SourceBytes read(std::size_t member, std::size_t most) const;

private:
    struct Lengths {
        std::size_t packed, expanded;
    };
    Lengths lengths_of(std::size_t member) const;
    [[noreturn]] void fail(const std::string& what) const;

    const SourceBytes& bytes_;
    std::unique_ptr<zip, void (*)(zip*)> archive_;
    std::vector<std::string> names_;
};

/// Writes an archive of members, each a name and its content, deflated; the same bytes at any time. Of a
/// content no more than a stretch is in memory, and of the archive nothing, but where the file is no file
/// that can be gone back in. Throws Error, Cancelled.
void write_zip(AtomicFile& file, const std::string& path,
               const std::vector<std::pair<std::string, LongText>>& members);

} // namespace hsdm::io
