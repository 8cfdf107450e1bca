#pragma once
// Handles too small for the grid: a web over the mouth of a slot, a tunnel through the foot of a wall.

#include "hsdm/contour/dual_mesh.hh"

namespace hsdm {

/// Finds and opens webs. Where two sheets of a wall or gap turn back into each other across a grid face (a
/// rim link) and another link crosses the same face, the two links could as well change partners: the ground
/// then turns up the wall instead of passing under it. That merges two chains of a voxel or divides one. A
/// web is a row of such faces, from a voxel where all four crossings are of one chain, through voxels where
/// the two links belong to two chains, to another where they are of one: changed together, they leave the
/// facets as they are and one vertex more at either end. So the Euler characteristic grows by two, and
/// repeating it comes to an end. Rows that share a chain are changed one at a time. Returns how many were; if
/// it is not 0 the dual vertices must be built again. O(links log links).
std::size_t open_webs(const Crossings& crossings, const DualVertices& duals, Links& links);

/// Opens webs, and builds the dual vertices anew, until there are no more. Returns how many there were.
std::size_t open_all_webs(const NormalSets& sets, double voxel_size, DualMesh& dual);

} // namespace hsdm
