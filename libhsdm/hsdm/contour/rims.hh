#pragma once
// Where a wall thinner than the sampling ends.

#include "hsdm/contour/place_vertices.hh"

namespace hsdm {

/// The sides of such a wall go on beyond their points to where a voxel ends, and so may a border of the
/// surface. Draws the vertices there (open ones, those of a rim link, and those beside them in voxels without
/// points) back to about a spacing from their sheets' nearest point: smooth ones along the sheet, those of a
/// crease along it; where a facet turned over, to amid their neighbours. `level`: that the sets were made
/// for. O(points beside rims and borders), parallel.
void draw_in_rims(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                  const DualMesh& mesh, PlacedVertices& vertices);

} // namespace hsdm
