#pragma once
// The writers behind write_mesh whose files are not rows of vertices and facets (mesh_document.hh), and what
// writers of all formats check.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/linked_mesh.hh"

namespace hsdm {

/// The normals and properties that a mesh has, which must outlive them.
VertexRows rows_of(const PolygonMesh& mesh);

/// Appended to an open file. In metres, if the unit is known; relative to a translation where floats are too
/// coarse. Vertices on creases are there once for each side, so that renderers, which know one normal a
/// vertex, draw the crease sharp. `path` is for messages.
void write_glb(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit);
void write_glb(AtomicFile& file, const std::string& path, const LinkedMesh& mesh, LengthUnit unit);
/// Appended to an open file. A mesh that is not `closed` is no body.
void write_3mf(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, bool closed,
               LengthUnit unit);

/// Throws Error for a mesh that contradicts itself, which writers rely on.
void check_consistent(const std::string& path, const PolygonMesh& mesh);
/// Throws Error for a mesh without facets, if the format has no such mesh.
void check_facets(const std::string& path, const PolygonMesh& mesh, MeshFormat format);
/// What floats do to positions less `shift`, and whether text is written for it.
WrittenMesh precision_of(std::span<const Vec3> positions, const Vec3& shift, MeshFormat format, bool ascii);

/// Through a half-edge mesh, into a file of its own. Throws Error if the facets are not 2-manifold.
void write_polygons_om(const std::string& path, const PolygonMesh& mesh);
void write_om(const std::string& path, const LinkedMesh& mesh);
struct OmSizes {
    std::size_t vertices, facets, edges;
    std::size_t property; ///< bytes of the largest one
};
/// Throws Error for what OpenMesh would number, or tell the size of, wrongly.
void check_sizes(const std::string& path, const OmSizes& sizes);

/// What writing takes of any kind of mesh, around write(facets, ascii): its facets as they are, or nearer to
/// the origin, if that is asked for, and whether they are to be text. Throws Error.
WrittenMesh write_checked(const std::string& path, const PolygonMesh& facets, MeshFormat format,
                          const WriteOptions& options,
                          const std::function<void(const PolygonMesh& facets, bool ascii)>& write);

} // namespace hsdm
