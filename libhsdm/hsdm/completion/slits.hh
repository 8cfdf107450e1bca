#pragma once
// Slits: boundary loops that are long and narrow are no borders, but gaps that the sampling left.

#include "hsdm/completion/complete_surface.hh"

#include <array>

namespace hsdm {

struct Slits {
    BoundaryLoops loops;
    std::vector<std::array<Vec3, 3>>
        closing; ///< triangles over the loops' vertices, which face as the mesh does
};

/// The loops that enclose a slit: of no more area to their length than a round hole `widest` across has,
/// slender or between two sheets that face apart, and not closed by going back over the mesh, as the outline
/// of a ribbon would be. Loops of more than 4,096 edges are none. O(length of loop ^ 3) each up to 128 edges,
/// ^ 2 beyond, but for those that enclose too much at first sight; parallel.
Slits find_slits(const PolygonMesh& mesh, const BoundaryLoops& loops, double widest);

/// Points of what closes slits, nine to a squared voxel and more, with its normals.
CompletedPoints points_across(const Slits& slits, double voxel_size);
/// The same of a mesh's triangles, but for the smallest.
CompletedPoints points_across(const PolygonMesh& triangles, double voxel_size);

} // namespace hsdm
