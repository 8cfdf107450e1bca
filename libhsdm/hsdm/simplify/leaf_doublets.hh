#pragma once
// Removes vertices at which only two facets of the coarse mesh meet.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// Removes inner vertices with only two facets: the two are merged into one, or removed if they are triangles
/// back to back. Half-edges go in opposite pairs, so closedness, orientation and Euler characteristic of what
/// is left do not change, and an edge that had four facets only because of such triangles has two afterwards.
/// Vertices between facets that share all their sides stay, as in a component of two facets; so do those that
/// are marked in `stays`, if it is not empty, and those that they share a path with. Returns per vertex the
/// one that stands for it now: itself, or a neighbour if it was removed (it is isolated then). O(facets) in
/// each of a few rounds.
std::vector<Index> dissolve_doublets(PolygonMesh& mesh, std::span<const std::uint8_t> stays = {});

/// Removes vertices that others stand for and renumbers the rest; `stands_for` has the new numbers
/// afterwards. Returns per vertex that is left its old number.
std::vector<Index> drop_replaced(PolygonMesh& mesh, std::vector<Index>& stands_for);

} // namespace hsdm
