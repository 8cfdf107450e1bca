#pragma once
// The points of a file, or of several, some of them at a time.

#include "hsdm/io/read_points.hh"

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace hsdm {

/// Files that are read anew each time they are visited. Where the format allows to read some of the points
/// (binary PLY with vertices of one size) they are not in memory as a whole; others are, one at a time. One
/// file alone of another format, and standard input, is read once and stays in memory. Not for several
/// threads.
class PointsInParts {
public:
    /// Opens files as read_points() does. Throws as that does, though not for what only reading all of them
    /// tells.
    PointsInParts(std::vector<std::string> paths, const ReadOptions& options);
    PointsInParts(const std::string& path, const ReadOptions& options)
        : PointsInParts(std::vector<std::string>{path}, options) {}

    /// Calls visit(part) for all points in their order. Throws Error.
    void visit(const std::function<void(const PointCloud&)>& visit) const { visit_share(0, 1, visit); }
    /// The same of one of several shares of about as many bytes: all together, in their order, are all
    /// points, each in one. Of a cloud that is in memory copies. Reads all of one file alone
    /// if its points are in memory, and of several those of other formats whose middle is in the share.
    void visit_share(int share, int shares, const std::function<void(const PointCloud&)>& visit) const;

    /// Counts the points; of several files it reads all those of other formats.
    std::size_t size() const;
    /// Differs where the files do, by their sizes and how they are read: whether several see the same.
    std::uint64_t fingerprint() const;
    bool in_memory() const { return one_.has_value(); }
    /// What is told beside the cloud of the files that were read so far; if in_memory() the cloud too.
    const PointFile& file() const& { return one_ ? *one_ : notes_; }
    PointFile file() && { return std::move(*one_); }

private:
    /// One of the files.
    struct Source {
        std::string path;
        std::uint64_t bytes = 0;
        std::optional<std::size_t> rows{}; ///< none: it is read as a whole
        bool is_noted = false;             ///< what is told of it beside its cloud
    };
    void visit_rows(const Source& source, std::size_t begin, std::size_t end,
                    const std::function<void(const PointCloud&)>& visit) const;
    PointFile read(Source& source) const;
    std::uint64_t bytes() const; ///< of all files

    ReadOptions options_;
    mutable std::vector<Source> sources_;
    bool moved_ptx_ = false;       ///< several begin at one place, which tells of no scanner (JoinedPoints)
    std::optional<PointFile> one_; ///< alone, and in memory
    mutable PointFile notes_;
};

} // namespace hsdm
