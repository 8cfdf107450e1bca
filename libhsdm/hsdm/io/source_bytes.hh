#pragma once
// The bytes of a file or of standard input.

#include <algorithm>
#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

namespace hsdm::io {

/// A source's content: of a regular file only the head at first, the rest when it is asked for. Always a
/// copy, never a mapping: a file that shrinks while it is read gives an error, not a bus error.
class SourceBytes {
public:
    static constexpr std::size_t head_size = std::size_t(1) << 16;

    /// Opens a file; "-" is standard input, which is read to its end. Throws Error saying what cannot be
    /// opened or read and why.
    static SourceBytes open(const std::string& path);
    /// Reads a stream to its end; `name` stands in messages for the file. Throws Error.
    static SourceBytes read(std::istream& stream, const std::string& name);

    /// Bytes that are in memory already.
    static SourceBytes of(std::unique_ptr<char[]> bytes, std::size_t size, const std::string& name);

    SourceBytes(SourceBytes&& other) noexcept;
    SourceBytes& operator=(SourceBytes&&) = delete;
    ~SourceBytes();

    /// As messages name the source: the path, or `<stdin>`.
    const std::string& name() const { return name_; }
    /// Bytes in all.
    std::size_t size() const { return size_; }
    /// The first bytes: head_size, or all if there are fewer.
    std::string_view head() const { return {bytes_.get(), std::min(size_, head_size)}; }
    /// All bytes; the first call reads them, in parallel, and moves the head. Throws Error.
    std::string_view view() const;
    /// Bytes offset .. offset + count, which must exist: in `scratch` (of `count` bytes), or where they are
    /// already. For large files read piece by piece, from any thread. Throws Error.
    const char* piece(std::size_t offset, std::size_t count, char* scratch) const;

private:
    SourceBytes(std::string name, std::size_t size);
    void read_at(char* bytes, std::size_t count, std::size_t offset) const;
    static SourceBytes read_stream(int descriptor, const std::string& name);

    std::string name_;
    std::size_t size_;
    mutable std::unique_ptr<char[]> bytes_; ///< all of them, or the head
    mutable bool complete_ = true;
    int descriptor_ = -1; ///< of the regular file that the rest is read from
};

/// Throws Error, as SourceBytes::open() does, for a path that cannot be opened, and reads nothing: for files
/// that are asked for long before they are read.
void check_readable(const std::string& path);

} // namespace hsdm::io
