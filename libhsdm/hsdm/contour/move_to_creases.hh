#pragma once
// Section 3.4.2: vertices of creases that lie just outside their voxels.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Moves vertices that were kept in their voxels to their creases, one after the other, where no facet turns
/// by 45 degrees, each then faces along one of the two sheets (45 degrees), or rather so than before, and
/// they come no closer than a tenth of a voxel to other vertices of these; and back where facets that share
/// vertices with theirs intersect. `mesh`: the facets, vertices numbered as in `vertices`. Returns how many
/// moved; they are no longer clamped. O(corners + c log c) for c corners of facets at such vertices and
/// beside.
std::size_t move_to_creases(PolygonMesh& mesh, double voxel_size, PlacedVertices& vertices);

} // namespace hsdm
