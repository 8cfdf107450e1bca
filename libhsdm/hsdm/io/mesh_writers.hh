#pragma once
// The writers behind write_mesh, one per format; each appends a complete document to an open file.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

void write_off(AtomicFile& file, const PolygonMesh& mesh);
void write_obj(AtomicFile& file, const PolygonMesh& mesh);
void write_ply(AtomicFile& file, const PolygonMesh& mesh, bool ascii);
/// Returns whether it wrote text, which it also does where floats are too coarse (see write_mesh).
bool write_stl(AtomicFile& file, const PolygonMesh& mesh, bool ascii);

/// Through a half-edge mesh, into a file of its own. Throws Error if the facets are not 2-manifold.
void write_polygons_om(const std::string& path, const PolygonMesh& mesh);

} // namespace hsdm
