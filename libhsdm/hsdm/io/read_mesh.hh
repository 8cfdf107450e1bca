#pragma once
// OFF, STL, PLY, OBJ, .om -> PolygonMesh, polygons and doubles kept: what `info`, `compare`, `process` and
// the tests read back.

#include "hsdm/io/read_points.hh"
#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// Reads a polygon mesh; STL corners at the same position become one vertex. A file without faces gives a
/// mesh without facets. Of .om also the sharp edges are read. Throws Error `FILE:LINE: what, and what to do`.
/// The vertices of a mesh with facets are finite.
PolygonMesh read_mesh(const std::string& path);

/// What a file holds: a mesh with facets, or, if it has none, its points.
struct MeshOrPoints {
    PolygonMesh mesh; ///< empty if the file has no facets
    PointFile points; ///< empty if it has
};

/// Reads whichever it is, found as read_points finds formats; "-" is standard input. Throws as the two do.
MeshOrPoints read_mesh_or_points(const std::string& path);

} // namespace hsdm
