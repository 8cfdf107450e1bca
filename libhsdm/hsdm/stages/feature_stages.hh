#pragma once
// The stages that obey or set the marks of phase 3; the first two are processing modules too (plugins/).

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
#define HSDM_SMOOTH_DESCRIPTION                                                                              \
    "moves vertices along filtered normals; sharp edges marked, corners and the boundary are kept"
#define HSDM_SMOOTH_OPTIONS                                                                                  \
    "rounds=1 (count): of filtering normals and moving vertices, more for noise; "                           \
    "normal-rounds=5 (count): of filtering in each; position-rounds=5 (count): of moving in each; "          \
    "similarity-degrees=20 (angle): normals that differ by more hardly count; "                              \
    "corner-degrees=60 (angle): turn of a crease that makes a corner; "                                      \
    "max-drift= (length): no vertex moves farther; "                                                         \
    "max-drift-share=0.25 (share): without it, the same in mean edges; "                                     \
    "max-volume-change=0.01 (share): of the volume of a closed mesh"
#define HSDM_SUBDIVIDE_DESCRIPTION                                                                           \
    "divides facets by Loop's or Catmull's and Clark's scheme; sharp edges marked and the boundary are "     \
    "creases"
#define HSDM_SUBDIVIDE_OPTIONS                                                                               \
    "scheme=auto (auto|loop|catmull-clark): auto takes loop where all facets are triangles; "                \
    "rounds=1 (count): each makes about four facets of one, at most 10; "                                    \
    "corner-degrees=60 (angle): turn of a crease or boundary that makes a corner"

namespace hsdm {

/// classify_features().
std::string classify_stage(PolyMesh& mesh, const PluginOptions& options);
/// smooth_normals().
std::string smooth_normals_stage(PolyMesh& mesh, const PluginOptions& options);
/// smooth_vertices().
std::string smooth_stage(PolyMesh& mesh, const PluginOptions& options);
/// subdivide().
std::string subdivide_stage(PolyMesh& mesh, const PluginOptions& options);

} // namespace hsdm
