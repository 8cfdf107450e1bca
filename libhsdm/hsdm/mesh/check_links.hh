#pragma once
// Whether a half-edge mesh that others have changed can be walked at all.

#include "hsdm/mesh_types.hh"

#include <string>

namespace hsdm {

/// What is wrong with the mesh, in words that follow "left"; empty if it is sound: its elements that are not
/// deleted refer to each other alone, half-edges form closed loops, each loop of three or more is one face or
/// borders none, the half-edges out of a vertex form one fan, beginning at its boundary if it has one,
/// positions are finite, and normals and status bits are there. Every walk over such a mesh ends. Any links
/// will do for input, also ones that lead nowhere. O(half-edges).
std::string fault_of(const PolyMesh& mesh);

/// Makes zero, "no normal here", of the vertices' normals that are not finite, `hsdm_normals` too: OpenMesh
/// leaves those of new vertices uninitialised.
void drop_nonfinite_normals(PolyMesh& mesh);

} // namespace hsdm
