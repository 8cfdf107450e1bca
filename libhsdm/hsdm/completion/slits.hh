#pragma once
// Slits: boundary loops that are long and narrow are no borders, but gaps that the sampling left.

#include "hsdm/completion/complete_surface.hh"

namespace hsdm {

/// The loops that enclose a slit: of no more area to their length than a round hole `widest` across has,
/// slender, and not closed by going back over the mesh, as the outline of a ribbon would be. As a list of
/// their own. O(length of loop ^ 2) each, but for those that enclose too much at first sight.
BoundaryLoops narrow_loops(const PolygonMesh& mesh, const BoundaryLoops& loops, double widest);

/// Points of facets over the loops' own vertices, three to a voxel each way, with the facets' normals.
CompletedPoints points_across(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size);

} // namespace hsdm
