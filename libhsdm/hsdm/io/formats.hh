#pragma once
// The readers behind read_points, one per family of formats. Each throws Error for what it cannot read.

#include "hsdm/io/read_points.hh"
#include "hsdm/io/text.hh"

#include <functional>

namespace hsdm::io {

/// Enters the scanners that the caller knows. Throws Error if there is no such column.
void set_sensors(const SourceBytes& bytes, const ReadOptions& options, PointCloud& cloud);

/// What the file's name or the caller says of a table: decides only what its values leave open.
enum class TableKind { plain, pts, pwn, xyzrgb };

/// XYZ, XYZN, XYZRGB, TXT, ASC, CSV, PTS, PWN: rows of numbers, with or without a header, a count, comments.
PointFile read_table(const SourceBytes& bytes, TableKind kind, const std::string& columns);
PointFile read_ply(const SourceBytes& bytes);
/// The number of a binary file's vertices if these are of one size; nothing for other files.
std::optional<std::size_t> ply_rows(const SourceBytes& bytes);
/// Calls visit() with the vertices [begin, end) of a binary file whose vertices are of one size, or those
/// of them that there are, so many at once, each time with the sensor; false, and nothing done, for other
/// files.
bool read_ply_in_parts(const SourceBytes& bytes, std::size_t begin, std::size_t end, std::size_t points,
                       const std::function<void(PointCloud&&)>& visit);
/// The points of a PCD file, as text, binary or compressed; those whose coordinates are not finite, pixels
/// without a measurement, are left out. The sensor is the viewpoint, if that is not zero.
PointFile read_pcd(const SourceBytes& bytes);
/// Whether the text begins as a PCD header does.
bool is_pcd(const Text& text);
/// A terrestrial scanner's grids, each with its matrix to world coordinates, in which the points are given;
/// rays without a hit are left out. The sensor is set if there is one scan only, else those of all scans,
/// unless all are at one place.
PointFile read_ptx(const SourceBytes& bytes);
/// Whether the text begins with the ten header lines of a PTX scan.
bool is_ptx(const Text& text);
/// Where the scanner of the first scan stood; nothing for other files.
std::optional<Vec3> ptx_scanner(const SourceBytes& bytes);
/// ASPRS LAS 1.0 to 1.4, uncompressed, every point format: positions, and colour, intensity, classification
/// and point_source_id where one of them is not zero. Points marked as withheld are left out and counted.
PointFile read_las(const SourceBytes& bytes);
/// Whether the bytes begin as those of a LAS or LAZ file.
bool is_las(const SourceBytes& bytes);
/// NumPy's array: structured, or rows of three numbers and more, whose columns are `columns` or told as those
/// of a table.
PointFile read_npy(const SourceBytes& bytes, const std::string& columns);
bool is_npy(const SourceBytes& bytes);
/// NumPy's arrays in an archive: `points` (or the like, or the only one that may be) as read_npy, `normals`,
/// `colors`, and as scalars the others that have one number for each point.
PointFile read_npz(const SourceBytes& bytes, const std::string& columns);
/// Whether the bytes begin as those of a ZIP archive whose first member is an array.
bool is_npz(const SourceBytes& bytes);
PointFile read_off(const SourceBytes& bytes);
/// The vertices that are not deleted and their normals, if one of them is not zero.
PointFile read_om(const SourceBytes& bytes);
/// Whether the bytes begin as those of an .om file.
bool is_om(const SourceBytes& bytes);
PointFile read_obj(const SourceBytes& bytes);
/// Hoppe's point files: lines `p x y z`, others skipped.
PointFile read_hoppe(const SourceBytes& bytes);
/// Text or binary; corners at the same position become one point, in order of first appearance.
PointFile read_stl(const SourceBytes& bytes);
/// The corners of all triangles of an STL file, text or binary, three for each.
std::vector<Vec3> read_stl_corners(const SourceBytes& bytes);
/// Whether the size is the one that a binary STL header announces.
bool is_binary_stl(const SourceBytes& bytes);
bool is_text_stl(const SourceBytes& bytes);
/// Whether the line is the first of an OFF file: the keyword, perhaps with its letters.
bool is_off_keyword(std::string_view line);

/// "ply", "off", "obj", "stl" or "om" if read_points would read the source as that; else empty: it holds no
/// faces.
std::string_view mesh_format_of(const SourceBytes& bytes);

/// Finds the reader by `options.format`, the name's extension and the content, and runs it.
PointFile read_points(const SourceBytes& bytes, const ReadOptions& options);

} // namespace hsdm::io
