#pragma once
// The two bodies a PLY header can have, read into the columns of a cloud.

#include "hsdm/io/columns.hh"
#include "hsdm/io/ply_header.hh"

#include <array>
#include <limits>
#include <optional>
#include <span>

namespace hsdm::io {

/// Reads element `vertex` of the header's elements; `columns` has one entry per property of it, lists being
/// skip; `text` is the whole source. Counts are held against the file before anything is allocated. Throws
/// Error.
PointCloud read_ply_ascii(const Text& text, const PlyHeader& header, std::size_t vertex,
                          const std::vector<Column>& columns);
/// Some of a file's vertices; all where nothing is said.
struct PlyRows {
    std::size_t first = 0, count = std::numeric_limits<std::size_t>::max();
};
/// Of vertices that hold lists, all are read.
PointCloud read_ply_binary(const SourceBytes& bytes, const PlyHeader& header, std::size_t vertex,
                           const std::vector<Column>& columns, const PlyRows& rows = {});

/// An element `camera` of which the position is known: where it stands among the header's elements, and the
/// properties view_px, view_py, view_pz among its own.
struct PlyCamera {
    std::size_t element;
    std::array<std::size_t, 3> position;
};
/// The only camera of a file, if it says its position.
std::optional<PlyCamera> find_camera(const PlyHeader& header);
/// The position among the values of the camera's properties; none if it is not finite or the zero that stands
/// for an unknown one.
std::optional<Vec3> sensor_of_camera(const PlyCamera& camera, std::span<const double> values);
/// The same, read from the body. Throws Error if the file ends before it.
std::optional<Vec3> read_ply_sensor_ascii(const Text& text, const PlyHeader& header, const PlyCamera& camera);
std::optional<Vec3> read_ply_sensor_binary(const SourceBytes& bytes, const PlyHeader& header,
                                           const PlyCamera& camera);

/// Whether colours of these columns are fractions of 1 by their type.
bool has_fractional_color(const PlyElement& vertex, const std::vector<Column>& columns);
/// Whether every colour is of one unsigned type of 1 or 2 bytes, whose range is its scale; then its factor.
std::optional<double> color_factor_by_type(const PlyElement& vertex, const std::vector<Column>& columns);

} // namespace hsdm::io
