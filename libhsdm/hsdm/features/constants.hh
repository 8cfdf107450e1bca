#pragma once
// Tuning values of phase 3 beside FeatureOptions and those of the templates, which stand in
// feature_options.hh and FeatureClassifierT_impl.hh. What half and double do: docs/constants.md.

#include "hsdm/core/tuned.hh"

// normal_filter.hh
namespace hsdm::normal_filters {

/// factor: that a neighbour counts at most of the facet itself.
/// Why: by trial; a sliver beside a large facet takes its normal, a facet beside three as large keeps a say.
HSDM_TUNED double most_of_own = 2;

} // namespace hsdm::normal_filters

// vertex_smoothing.hh
namespace hsdm::vertex_smoothings {

/// share: of a facet's area, as seen along its filtered normal, that one step has to leave.
/// Why: steps go along normals, so a facet that loses nine tenths is about to turn over. No reconstruction
/// asks for it.
inline constexpr double least_area_left = 0.1;

} // namespace hsdm::vertex_smoothings
