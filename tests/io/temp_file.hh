#pragma once
// A file that lives as long as its test needs it, and how its bytes are put together.

#include "hsdm/io/read_points.hh"
#include "support/folder.hh"

#include <bit>
#include <cstring>
#include <string>

namespace hsdm::test {

/// A file of the given name (it decides the format) in a folder of its own, removed at the end.
class TempFile {
public:
    TempFile(const std::string& name, const std::string& content) : path_(folder_.write(name, content)) {}
    const std::string& path() const { return path_; }

private:
    support::Folder folder_;
    std::string path_;
};

inline PointFile read(const std::string& name, const std::string& content, const ReadOptions& options = {}) {
    return read_points(TempFile(name, content).path(), options);
}

/// The message of the error that reading gives, its folder taken away; empty if there is none.
inline std::string error_of(const std::string& name, const std::string& content,
                            const ReadOptions& options = {}) {
    const TempFile file(name, content);
    try {
        read_points(file.path(), options);
    } catch (const std::exception& error) {
        std::string message = error.what();
        const std::string folder = file.path().substr(0, file.path().size() - name.size());
        if (message.starts_with(folder)) message.erase(0, folder.size());
        return message;
    }
    return "";
}

/// The bytes of a value in either byte order.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big_endian != (std::endian::native == std::endian::big)) bytes.assign(bytes.rbegin(), bytes.rend());
    return bytes;
}

} // namespace hsdm::test
