#pragma once
// Bytes on disk that are read again, in a file without a name, or in one that another process may go on with.

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

namespace hsdm {

/// Where scratch goes.
struct ScratchPlace {
    std::string folder{};   ///< empty: that for temporary files (TMPDIR, else /tmp)
    std::string name{};     ///< of the file, which stays; empty: it has none, and nothing is left of it
    std::size_t is_there{}; ///< so many bytes of that file, from the first on, hold what they should
};

/// Of all files of the process so far.
struct ScratchUse {
    std::size_t written = 0; ///< bytes, whatever became of them
    std::size_t most = 0;    ///< bytes in files at once
};
ScratchUse scratch_use();

/// Without a name nothing is left of the file, however the process ends. Not for several threads, but for
/// read().
class ScratchBytes {
public:
    /// Throws Error if the file cannot be made, or opened where it is there.
    explicit ScratchBytes(const ScratchPlace& place);
    ~ScratchBytes();
    ScratchBytes(const ScratchBytes&) = delete;
    ScratchBytes& operator=(const ScratchBytes&) = delete;

    /// Throws Error, which says `needed` and what there is, if the disk has less room than so many bytes.
    /// `what` names them.
    void check_room(const char* what, std::size_t needed) const;

    /// Has the disk room for so many bytes more? False if that cannot be told.
    bool has_room(std::size_t needed) const;

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
    /// Returns once the disk has all. Throws Error if that fails.
    void flush_to_disk() const;

private:
    void open(const std::string& path, std::size_t is_there);

    std::string folder_;
    int file_ = -1;
    std::size_t size_ = 0;
};

} // namespace hsdm
