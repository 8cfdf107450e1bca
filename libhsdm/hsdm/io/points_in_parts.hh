#pragma once
// The points of a file, some of them at a time.

#include "hsdm/io/read_points.hh"

#include <functional>
#include <optional>
#include <utility>

namespace hsdm {

/// A file that is read anew each time it is visited, where its format allows to read some of its points
/// (binary PLY with vertices of one size); of other files, and of standard input, the cloud stays in memory.
class PointsInParts {
public:
    /// Opens a file as read_points() does. Throws as that does, though not for what only reading all of it
    /// tells.
    PointsInParts(const std::string& path, const ReadOptions& options);

    /// Calls visit(part) for all points in their order. Throws Error.
    void visit(const std::function<void(const PointCloud&)>& visit) const;
    /// The same of the points [begin, end) alone; of a cloud in memory that is not all of it a copy,
    /// without sensors.
    void visit(std::size_t begin, std::size_t end, const std::function<void(const PointCloud&)>& visit) const;

    std::size_t size() const { return rows_ ? *rows_ : file_.cloud.size(); }
    bool in_memory() const { return !rows_; }
    /// What was read beside the cloud; if in_memory() this too.
    const PointFile& file() const& { return file_; }
    PointFile file() && { return std::move(file_); }

private:
    std::string path_;
    std::optional<std::size_t> rows_; // none: all is in memory
    PointFile file_;
};

} // namespace hsdm
