#pragma once
// Vertices that hold nothing open: only two facets of the coarse mesh meet there.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Takes out inner vertices with only two facets: the two become one, or go altogether if they are triangles
/// back to back. Sides go in opposite pairs, so closedness, orientation and Euler characteristic of what is
/// left stay as they are; an edge that only such triangles made one of four facets becomes one of two. Left
/// alone: vertices whose two facets share more, as in a component of two facets. Returns per vertex the one
/// that stands for it now: itself, or a neighbour if it was taken out (it is isolated then). O(facets) in
/// each of a few rounds.
std::vector<Index> dissolve_doublets(PolygonMesh& mesh);

} // namespace hsdm
