#pragma once
// Bytes on disk that are read again, in a file without a name.

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace hsdm {

/// Nothing is left of the file, however the process ends. Not for several threads.
class ScratchBytes {
public:
    /// `folder`: where the file is made; empty: that for temporary files (TMPDIR, else /tmp). Throws Error if
    /// it cannot be made.
    explicit ScratchBytes(const std::string& folder);
    ~ScratchBytes();
    ScratchBytes(const ScratchBytes&) = delete;
    ScratchBytes& operator=(const ScratchBytes&) = delete;

    /// Throws Error, which says `needed` and what there is, if the disk has less room than so many bytes.
    /// `what` names them.
    void check_room(const char* what, std::size_t needed) const;

    /// Appends; returns where. Throws Error if the disk is full.
    std::size_t append(const char* what, const void* bytes, std::size_t count);
    /// Throws Error if the file cannot be read.
    void read(std::size_t offset, void* bytes, std::size_t count) const;

    /// The same of values; `read` replaces what the vector holds.
    template <class T>
    std::size_t append(const char* what, const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        return append(what, values.data(), values.size() * sizeof(T));
    }
    template <class T>
    void read(std::size_t offset, std::size_t count, std::vector<T>& values) const {
        values.resize(count);
        read(offset, values.data(), count * sizeof(T));
    }

    std::size_t size() const { return size_; } ///< written so far

private:
    std::string folder_;
    int file_ = -1;
    std::size_t size_ = 0;
};

} // namespace hsdm
