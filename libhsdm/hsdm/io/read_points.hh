#pragma once
// Point files -> PointCloud. PLY, XYZ / TXT / ASC / CSV, PTS, PWN, Hoppe's `p x y z`, vertices of OFF, OBJ,
// STL.

#include "hsdm/point_cloud.hh"

#include <string>

namespace hsdm {

struct ReadOptions {
    std::string format; ///< "ply", "xyz", "csv", "pts", "pwn", "off", "obj", "stl"; empty: by extension, then
                        ///< by content
    std::string columns; ///< text only, e.g. "x,y,z,nx,ny,nz,r,g,b,_"; empty: told from the data
};

/// What was read, beside the cloud.
struct PointFile {
    PointCloud cloud;
    std::string format;    ///< the format found
    std::size_t faces = 0; ///< faces in the file, which were skipped
};

/// Reads the points of a file; "-" is standard input. Coordinates that are not finite are kept (see
/// drop_nonfinite). Throws Error `FILE:LINE: what, and what to do` if the file cannot be opened, is empty,
/// truncated or malformed.
PointFile read_points(const std::string& path, const ReadOptions& options = {});

} // namespace hsdm
