#pragma once
// Removes vertices that carry nothing: in the middle of a flat place or of a straight crease.

#include "hsdm/simplify/collapsing_mesh.hh"

namespace hsdm {

/// Removes inner vertices round which the surface is flat, or flat on both sides of one crease that goes
/// straight on there: the hole is triangulated with the neighbours alone. A plain edge collapse needs one
/// neighbour that sees all others; cutting ears only needs two that see each other past a third, and on a
/// flat place there always are. The neighbours may be off a plane, and the vertex off the line between the
/// crease's ends, by the vertex's `reach` as the mesh is then (per vertex, the mesh's units); with 0 a vertex
/// stays, and nothing merges into it. A vertex also stays where triangles would get thinner than the thinnest
/// there. Returns how many were removed. O(n) in each of 4 rounds.
std::size_t remove_flat_vertices(CollapsingMesh& mesh, const std::vector<double>& reach);

} // namespace hsdm
