// Marks the sharp edges of a mesh and classifies its vertices (section 3.3).

#include "hsdm/stages/feature_stages.hh"

HSDM_PLUGIN("classify-features", HSDM_CLASSIFY_DESCRIPTION, HSDM_CLASSIFY_OPTIONS, hsdm::classify_stage)
