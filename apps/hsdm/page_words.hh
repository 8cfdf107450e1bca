#pragma once
// A report in plain words, as HTML.

#include "page_mesh.hh"

#include "hsdm/report.hh"

namespace hsdm::command {

/// "12,345", "0.0217", "1.5e-07": as people read numbers.
std::string page_number(double value, int digits = 4);

/// What matters at a glance, each `<li>`: is it closed, are there warnings.
std::string verdict_items(const Report& report);
/// Key figures, each `<div>` with a number and what it counts.
std::string key_figures(const Report& report);
/// Sentences in sections, each `<section>`: what went in, the resolution, what came out, topology, errors,
/// times.
std::string report_sections(const Report& report);
/// Rows of a table of the deviations' figures.
std::string deviation_rows(const DeviationFigures& figures);
/// Places to look at, each `<li>` with a button that has data-place="x y z": warnings, what was dropped,
/// boundary loops, the farthest points.
std::string places_to_look(const Report& report, const DeviationFigures& figures);

} // namespace hsdm::command
