#pragma once
// Walls round what goes on straight beyond a mesh's border: bores, slots, channels.

#include "hsdm/mesh/fill_holes.hh"

#include <functional>

namespace hsdm {

/// Calls visit(along, against) once per axis of a mesh, with sides of its border swept along it and against
/// it, as far as the mesh is wide, two triangles each, facing as the mesh. Where the mesh beside a loop is
/// straight it tells an axis: the ruling of a round wall, or what two planes have in common, if many of the
/// loop's sides lie on walls of it that are not all parallel. What loops tell within
/// `continuing::one_direction` is one axis, of all of them; of more than `continuing::most_axes` those that
/// most border lies on walls of. Of every loop those sides go on along an axis that lie on walls of it and
/// lead along it, or on faces that it enters. `mesh`: facets outward. O(facets + border * (facets within
/// `continuing::reach` + axes)).
void for_each_continued_wall(
    const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size,
    const std::function<void(const PolygonMesh& along, const PolygonMesh& against)>& visit);

} // namespace hsdm
