#pragma once
// The files that a run reads and writes, known before it starts, so that none of them destroys another.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hsdm::command {

class FileClaims {
public:
    /// `what` names it in messages: "the input". "-" is standard input.
    void reads(const std::string& what, const std::string& path);
    /// `option` is what the user wrote, e.g. "-o part.off", and `path` the file that comes of it. "-" is
    /// standard output.
    void writes(const std::string& option, const std::string& path);

    /// Throws UsageError naming two that are one file, by device and inode where it is there, else by its
    /// folder's and the name, if one of them writes: a file would be lost, or be a mixture. Many may read
    /// one; /dev/null takes everything; terminals and sockets are read and written. O(n log n).
    void check() const;

private:
    struct Claim {
        std::uint64_t device = 0; ///< of the file, or of the folder above it that is there
        std::uint64_t inode = 0;
        std::string below; ///< the way from there on
        std::size_t order = 0;
        bool writes = false, two_way = false;
        std::string words;
    };
    void add(Claim claim, const std::string& path, int standard);

    std::vector<Claim> claims_;
};

/// True for "-", /dev/stdout and whatever else is the file that standard output is, but for /dev/null.
bool is_standard_output(const std::string& path);

} // namespace hsdm::command
