#pragma once
// The figures of docs/sheets.md, docs/adaptive.md, docs/features.md, docs/stages.md and
// docs/neighbors.md, by name.

#include "canvas.hh"

namespace hsdm::figures {

Canvas draw_sets();
Canvas draw_relations();
Canvas draw_signs();
Canvas draw_crossings();
Canvas draw_pairs();
Canvas draw_thin_part();
Canvas draw_placing();
Canvas draw_border();
Canvas draw_creases_outside();

Canvas draw_leaves();
Canvas draw_clusters();
Canvas draw_patches();
Canvas draw_collapses();
Canvas draw_flips();
Canvas draw_error_bound();

Canvas draw_carried();
Canvas draw_classes();
Canvas draw_normals();
Canvas draw_decimated();
Canvas draw_filled();
Canvas draw_smoothed();
Canvas draw_divided();

} // namespace hsdm::figures
