#pragma once
// Where a wall thinner than the sampling ends.

#include "hsdm/contour/place_vertices.hh"

namespace hsdm {

/// The sides of such a wall go on beyond their points to where a voxel ends, and so may a border of the
/// surface. Draws the vertices there (open ones, and those of a rim link) back to within a spacing of their
/// sheets' nearest point, as far as no facet round them turns over: smooth ones along the sheet, those of a
/// crease along it. `level`: that the sets were made for. O(points beside rims and borders), parallel.
void draw_in_rims(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                  const DualMesh& mesh, PlacedVertices& vertices);

} // namespace hsdm
