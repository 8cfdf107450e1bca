#pragma once
// Point files -> PointCloud. PLY, PCD, XYZ / TXT / ASC / CSV, PTS, PTX, PWN, LAS, NPY, NPZ, Hoppe's `p x y
// z`, vertices of OFF, OBJ, STL, .om.

#include "hsdm/point_cloud.hh"

#include <span>
#include <string>
#include <string_view>

namespace hsdm {

/// How a file is to be read, where it does not say so itself.
struct ReadOptions {
    /// One of point_formats(); empty: by the content where that is a sure sign, else by the file's extension.
    std::string format{};
    /// Tables and plain NPY arrays only: what each column is, e.g. "x,y,z,nx,ny,nz,r,g,b,_" (`_` is skipped);
    /// empty: told by a header line, else from the values. Throws OptionError if it cannot be.
    std::string columns{};
    /// Where scanners stood, in the file's units; in place of what the file says.
    std::vector<Vec3> sensors{};
    /// The column or property that says which of them saw a point, by its number from 0 on; empty if it is
    /// one alone. Throws Error if the file has none of that name.
    std::string sensor_column{};
};

/// The values of ReadOptions::format, which are also the extensions known: "ply", "pcd", "xyz" and "xyzn",
/// "xyzrgb", "csv", "txt", "asc" (the same), "pts", "pwn", "ptx", "las", "npy", "npz", "off", "obj", "stl",
/// "om", "hoppe".
std::span<const std::string_view> point_formats();

/// What was read, beside the cloud.
struct PointFile {
    PointCloud cloud;      ///< in the file's units
    std::string format;    ///< the format found, by the names above
    std::size_t faces = 0; ///< faces in the file, which were skipped
    /// Points without coordinates, left out while reading: pixels and rays without a return.
    std::size_t nonfinite = 0;
    std::size_t withheld = 0;     ///< points that a LAS file marks as deleted, left out while reading
    Vec3 first_withheld{0, 0, 0}; ///< where the first of them was
    /// Tables and plain arrays whose columns were told from their values alone: what each was taken for, e.g.
    /// "x,y,z,nx,ny,nz", so that whoever knows better can say so in ReadOptions::columns. Else empty.
    std::string columns{};
    /// Of several files that were joined: what some have and others do not, which is left out.
    std::vector<std::string> partial{};
};

/// Throws OptionError for options that do not fit it. read_points() does so too.
void check_options(const ReadOptions& options);

/// Reads the points of a file; "-" is standard input. Coordinates that are not finite are kept (see
/// drop_nonfinite), but for pixels of a PCD file, which are counted. Throws Error `FILE:LINE: what, and what
/// to do` if the file cannot be opened, is empty, truncated or malformed; OptionError for options that do not
/// fit it. O(bytes), parallel; binary PLY files are not held in memory as a whole.
PointFile read_points(const std::string& path, const ReadOptions& options = {});

} // namespace hsdm
