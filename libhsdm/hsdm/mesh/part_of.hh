#pragma once
// Facets of a mesh as a mesh of their own, and facets of several as those of one.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The facets with these indices, in this order, over the positions that they use; without properties and
/// normals. `number`, if given, becomes per vertex of the mesh its index in the part, or no_index. O(vertices
/// of the mesh + facets of the part).
PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets,
                    std::vector<Index>* number = nullptr);

/// The facets, positions and origins of a large mesh again, without properties and normals.
PolygonMesh copy_of(const PolygonMesh& mesh);

/// The border of some facets, the way they run, from its least vertex on; empty if it is not one ring that
/// passes no vertex twice. O(f log f) for f facets.
std::vector<Index> border_of(const PolygonMesh& mesh, const std::vector<Index>& facets);

/// Appends the facets of parts, one part after the other, to a mesh whose vertices theirs are. Parallel.
void append_facets(PolygonMesh& mesh, const std::vector<PolygonMesh>& parts);

} // namespace hsdm
