#pragma once
// Walls round what goes on straight beyond a mesh's border: bores, slots, channels.

#include "hsdm/mesh/fill_holes.hh"

namespace hsdm {

/// Sides of the border swept along the axes of what they bound, two triangles each, as far as the mesh is
/// wide, facing as the mesh; those swept along an axis and those against it.
struct ContinuedWalls {
    PolygonMesh along, against;
};

/// A loop has an axis where the mesh beside it is straight: along the ruling of a round wall, or along what
/// two planes have in common. All of its sides go on along it that lie on walls of the axis and lead along
/// it, or on faces that it enters. `mesh`: facets outward. O(facets + border).
ContinuedWalls continued_walls(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size);

} // namespace hsdm
