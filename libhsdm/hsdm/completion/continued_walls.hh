#pragma once
// Walls round what goes on straight beyond a mesh's border: bores, slots, channels.

#include "hsdm/mesh/fill_holes.hh"

#include <functional>

namespace hsdm {

/// Calls visit(walls, along) with sides of the border swept along the axes of what they bound, as far as the
/// mesh is wide, two triangles each, facing as the mesh: all of one loop swept one way, which counts as along
/// its axis (of any two ways that are opposite about one does) or not. A loop has an axis where the mesh
/// beside it is straight: along the ruling of a round wall, or along what two planes have in common. All of
/// its sides go on along it that lie on walls of the axis and lead along it, or on faces that it enters.
/// `mesh`: facets outward. O(facets + border * (facets within
/// `continuing::reach` + axes)).
void for_each_continued_wall(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size,
                             const std::function<void(const PolygonMesh& walls, bool along)>& visit);

} // namespace hsdm
