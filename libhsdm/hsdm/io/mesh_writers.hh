#pragma once
// The writers behind write_mesh whose files are not rows of vertices and facets (mesh_document.hh); each
// appends a complete document to an open file.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/write_mesh.hh"

namespace hsdm {

void write_obj(AtomicFile& file, const PolygonMesh& mesh);

/// The normals and properties that a mesh has, which must outlive them.
VertexRows rows_of(const PolygonMesh& mesh);

/// In metres, if the unit is known; relative to a translation where floats are too coarse. Vertices on
/// creases are there once for each side, so that renderers, which know one normal a vertex, draw the crease
/// sharp. `path` is for messages.
void write_glb(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit);
void write_3mf(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit);

/// Throws Error for a mesh that contradicts itself, which writers rely on.
void check_consistent(const std::string& path, const PolygonMesh& mesh);
/// Throws Error for formats that cannot be written as they come.
void check_as_it_comes(const std::string& path, MeshFormat format);
/// What floats do to positions less `shift`, and whether text is written for it.
WrittenMesh precision_of(std::span<const Vec3> positions, const Vec3& shift, MeshFormat format, bool ascii);

/// Through a half-edge mesh, into a file of its own. Throws Error if the facets are not 2-manifold.
void write_polygons_om(const std::string& path, const PolygonMesh& mesh);

} // namespace hsdm
