#pragma once
// Where fairing would take a patch through the mesh or through itself.

#include "hsdm/completion/completion_patch.hh"

namespace hsdm {

/// The vertices of a patch, once each and ascending, that passed through a mesh on their straight way from
/// where they were, or whose missing facets now meet others of the patch. Nothing is said of held vertices.
/// O((patch + facets near it) log), parallel.
std::vector<Index> crossed_moves(const PolygonMesh& mesh, const CompletionPatch& patch,
                                 const std::vector<Vec3>& from);

} // namespace hsdm
