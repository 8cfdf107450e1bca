#pragma once
// Section 3.4.2: vertices clamped to their voxels whose crease lies just outside.

#include "hsdm/contour/place_vertices.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Moves such vertices onto their creases, one after the other, if no facet turns by 45 degrees, each facet
/// then faces along one of the two sheets (within 45 degrees, or better than before) and no vertex of those
/// facets comes closer than a tenth of a voxel. Moves them back where facets near by then intersect. `mesh`:
/// the facets, with vertices numbered as in `vertices`. Returns how many moved; these are no longer clamped.
/// O(corners + c log c) for c corners of facets at such vertices and beside.
std::size_t move_to_creases(PolygonMesh& mesh, double voxel_size, PlacedVertices& vertices);

} // namespace hsdm
