#pragma once
// The bytes of a file or of standard input, whole, and where in them a text line is.

#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

namespace hsdm::io {

/// A source's content in memory. It is a copy, not a mapping: a file that shrinks while it is read gives an
/// error, never a bus error.
class SourceBytes {
public:
    /// Reads a file, in parallel if it is a regular one; "-" reads standard input. Throws Error saying what
    /// cannot be opened or read and why.
    static SourceBytes open(const std::string& path);
    /// Reads a stream to its end; `name` stands in messages for the file. Throws Error.
    static SourceBytes read(std::istream& stream, const std::string& name);

    /// As messages name the source: the path, or `<stdin>`.
    const std::string& name() const { return name_; }
    const char* begin() const { return bytes_.get(); }
    const char* end() const { return bytes_.get() + size_; }
    std::size_t size() const { return size_; }
    std::string_view view() const { return {begin(), size_}; }

private:
    SourceBytes(std::string name, std::size_t size);
    static SourceBytes read_stream(int descriptor, const std::string& name);

    std::string name_;
    std::unique_ptr<char[]> bytes_;
    std::size_t size_;
};

} // namespace hsdm::io
