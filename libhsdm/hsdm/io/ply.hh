#pragma once
// The two bodies a PLY header can have, read into the columns of a cloud.

#include "hsdm/io/columns.hh"
#include "hsdm/io/ply_header.hh"

namespace hsdm::io {

/// Reads element `vertex` of the header's elements; `columns` has one entry per property of it, lists being
/// skip; `text` is the whole source. Counts are held against the file before anything is allocated. Throws
/// Error.
PointCloud read_ply_ascii(const Text& text, const PlyHeader& header, std::size_t vertex,
                          const std::vector<Column>& columns);
PointCloud read_ply_binary(const SourceBytes& bytes, const PlyHeader& header, std::size_t vertex,
                           const std::vector<Column>& columns);

/// Whether colours of these columns are fractions of 1 by their type.
bool has_fractional_color(const PlyElement& vertex, const std::vector<Column>& columns);
/// Whether every colour is of one unsigned type of 1 or 2 bytes, whose range is its scale; then its factor.
std::optional<double> color_factor_by_type(const PlyElement& vertex, const std::vector<Column>& columns);

} // namespace hsdm::io
