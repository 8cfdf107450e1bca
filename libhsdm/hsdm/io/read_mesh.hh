#pragma once
// OFF, STL, PLY, OBJ -> PolygonMesh, polygons and doubles kept: what `info`, `compare` and the tests read
// back.

#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// Reads a polygon mesh; STL corners at the same position become one vertex. A file without faces gives a
/// mesh without facets. Throws Error `FILE:LINE: what, and what to do`.
PolygonMesh read_mesh(const std::string& path);

} // namespace hsdm
