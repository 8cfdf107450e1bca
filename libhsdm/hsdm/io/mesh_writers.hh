#pragma once
// The writers behind write_mesh, one per format; each appends a complete document to an open file.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/write_mesh.hh"

namespace hsdm {

void write_off(AtomicFile& file, const PolygonMesh& mesh);
void write_obj(AtomicFile& file, const PolygonMesh& mesh);
void write_ply(AtomicFile& file, const PolygonMesh& mesh, const VertexRows& rows, bool ascii);
void write_stl(AtomicFile& file, const PolygonMesh& mesh, bool ascii);

/// The normals and properties that a mesh has, which must outlive them.
VertexRows rows_of(const PolygonMesh& mesh);

/// In metres, if the unit is known; relative to a translation where floats are too coarse. Vertices on
/// creases are there once for each side, so that renderers, which know one normal a vertex, draw the crease
/// sharp. `path` is for messages.
void write_glb(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit);
void write_3mf(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit);

/// Through a half-edge mesh, into a file of its own. Throws Error if the facets are not 2-manifold.
void write_polygons_om(const std::string& path, const PolygonMesh& mesh);

} // namespace hsdm
