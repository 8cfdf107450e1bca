#pragma once
// The readers behind read_mesh, one per format. Each throws Error for what it cannot read.

#include "hsdm/io/source_bytes.hh"
#include "hsdm/io/text.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm::io {

/// Finds the reader by the content and the name's extension, and runs it.
PolygonMesh read_mesh(const SourceBytes& bytes);

PolygonMesh read_mesh_off(const SourceBytes& bytes);
PolygonMesh read_mesh_obj(const SourceBytes& bytes);
/// OpenMesh's own format, whoever wrote it: vertices, faces, the vertices' normals, colours and properties of
/// one number, `hsdm_normals`, and the edges marked as features. Deleted faces are left out (not
/// deleted vertices, which have no faces), and so are attributes of edges and faces.
PolygonMesh read_mesh_om(const SourceBytes& bytes);
PolygonMesh read_mesh_ply(const SourceBytes& bytes);
/// Corners at the same position become one vertex, in order of first appearance.
PolygonMesh read_mesh_stl(const SourceBytes& bytes);

/// Throws unless every corner is one of the mesh's vertices. `facet_at`: where each facet stands in the text;
/// empty for a binary file.
void check_corners(const Text& text, const PolygonMesh& mesh, const std::vector<const char*>& facet_at);

/// An index from a file; no_index if it cannot be one, which check_corners then reports.
inline Index to_index(double value) {
    return value >= 0 && value < static_cast<double>(no_index) ? static_cast<Index>(value) : no_index;
}

} // namespace hsdm::io
