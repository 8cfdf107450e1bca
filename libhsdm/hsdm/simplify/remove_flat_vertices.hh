#pragma once
// Vertices that carry nothing: in the middle of a flat place or of a straight crease.

#include "hsdm/simplify/collapsing_mesh.hh"

namespace hsdm {

/// Takes out inner vertices round which all is flat, or all but one crease that goes straight on there: what
/// is about them is cut anew into triangles of their neighbours alone. An edge collapses onto a neighbour
/// only if that sees all others; of a flat place some neighbours always see each other. Vertices round one,
/// or the line between the crease's ends, may be off by its `reach` as the mesh is then (per vertex, the
/// mesh's units): with 0 a vertex stays, and nothing merges into it. What would get thinner than all is there
/// stays too. Returns how many were taken out. O(n) in each of 4 rounds.
std::size_t remove_flat_vertices(CollapsingMesh& mesh, const std::vector<double>& reach);

} // namespace hsdm
