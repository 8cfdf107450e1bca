#pragma once
// A small picture of a mesh.

#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm::command {

/// The pixels across and down.
constexpr int picture_width = 240, picture_height = 180;

/// A PNG file: the mesh in shades of blue before nothing, z up, seen from above at an angle, as large as
/// fits; sharp edges dark, and those of facets too where there are not too many to tell; where the inside of
/// a surface is seen it is orange. The same mesh gives the same bytes. O(facets + pixels that they cover).
/// Throws std::runtime_error where PNG's library fails.
std::string draw_picture(const PolygonMesh& mesh);

} // namespace hsdm::command
