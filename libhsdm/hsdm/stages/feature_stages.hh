#pragma once
// The stages of phase 3, which are processing modules too (plugins/).

#include "hsdm/plugin.hh"

/// What they do and their options, as HSDM_PLUGIN wants them.
#define HSDM_CLASSIFY_DESCRIPTION "marks sharp edges and classifies vertices as smooth, edge or corner"
#define HSDM_CLASSIFY_OPTIONS                                                                                \
    "crease-degrees=35 (angle): dihedral angle above which an edge is sharp; "                               \
    "corner-degrees=60 (angle): turn of a crease that makes a corner; "                                      \
    "confirmation-rounds=3 (count): 0 takes every dihedral angle at its word"
#define HSDM_SMOOTH_NORMALS_DESCRIPTION "smooths normals between the sharp edges marked; classify marks them"
#define HSDM_SMOOTH_NORMALS_OPTIONS                                                                          \
    "rounds=3 (count): of smoothing; similarity-degrees=20 (angle): normals that differ by more hardly "     \
    "count"

namespace hsdm {

/// classify_features().
std::string classify_stage(PolyMesh& mesh, const PluginOptions& options);
/// smooth_normals().
std::string smooth_normals_stage(PolyMesh& mesh, const PluginOptions& options);

} // namespace hsdm
