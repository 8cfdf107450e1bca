#pragma once
// Several scans of one thing -> one cloud.

#include "hsdm/io/read_points.hh"

#include <vector>

namespace hsdm {

/// Adds up scans, one after the other. What not all of them have (normals, colours, a scalar by its name) is
/// left out and named in PointFile::partial. Each scan's scanner is one of PointCloud::sensors, unless there
/// is but one and no file is sure of it: then it is PointCloud::sensor if all points have it. Several PTX
/// scans at one place were moved already, and tell of no scanner. Points of a scan that does not tell have
/// none.
class JoinedPoints {
public:
    /// Takes a scan's points.
    void add(PointFile&& scan);
    /// All that was added.
    PointFile take() &&;

private:
    void add_scalars(std::vector<Scalar>& next, std::size_t points);
    void add_sensors(const PointCloud& next);
    void leave_out(const std::string& what);

    PointFile all_;
    bool has_sure_sensors_ = false;
    std::size_t placed_ptx_ = 0; ///< PTX scans that tell of one place
};

/// What is told of a file beside its cloud, added to what is told of others.
void add_notes(const PointFile& next, PointFile& all);

/// Reads files one by one as read_points() does, and joins them in this order; one alone is as it is. Throws
/// as that does. O(bytes).
PointFile read_joined(std::span<const std::string> paths, const ReadOptions& options = {});

/// The files in a folder, not in those below, whose extensions are point_formats(), ordered by the bytes of
/// their names; those that begin with a dot are left out. Throws Error if there is none.
std::vector<std::string> point_files_in(const std::string& folder);

} // namespace hsdm
