#pragma once
// Bars and bores thinner than about two voxels. Between the edges of a grid a bar can pass unseen for voxels,
// as nothing crosses them there; so grid points move to its line, and edges lead along it and out of it. See
// docs/sheets.md.

#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// Moves grid points to the lines of bars and bores. One passes a grid face where sets go on from its one
/// side to the other, lie along one direction, and stand all round a place of the face, facing away from it
/// or all towards it. The corner of the face nearest to that place moves there, the nearest grid points in
/// the planes next to it to where the line goes on, as the bar may end on something there, and between them
/// those that make it a way of edges. None moves by more than a voxel, and of two places that want one the
/// nearer gets it. Returns how many lie off their places then. O(grid points), parallel; turned normals give
/// the same.
std::size_t move_to_bar_lines(GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                              double voxel_size);

/// Of the crossings on edges with a grid point off its place, those with no point of their sheet near by, or
/// that points of a bar or bore stand round, do not stand, and the data do not carry them: where bars end on
/// something, its sheets have holes that their planes do not know of. O(such crossings), parallel; turned
/// normals give the same.
void ask_points_at_bars(const Octree& octree, const OctreeLevel& level, const GridPoints& grid,
                        Crossings& crossings);

} // namespace hsdm
