// Smooths the normals of a mesh without averaging across the sharp edges marked on it (section 3.3, Fig. 10).

#include "hsdm/stages/feature_stages.hh"

HSDM_PLUGIN("smooth-normals", HSDM_SMOOTH_NORMALS_DESCRIPTION, HSDM_SMOOTH_NORMALS_OPTIONS,
            hsdm::smooth_normals_stage)
