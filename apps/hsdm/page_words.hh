#pragma once
// A report in plain words, as HTML.

#include "page_mesh.hh"

#include <nlohmann/json.hpp>

namespace hsdm::command {

using PageReport = nlohmann::json;

/// The report's JSON text; an empty object for none, and for what is no object.
PageReport parse_report(const std::string& text);
/// How far the farthest of the points is that the mesh was made of; 0 if the report does not say.
double largest_error_of(const PageReport& report);

/// "12,345", "0.0217", "1.5e-07": as people read numbers.
std::string page_number(double value, int digits = 4);

/// What matters at a glance, each `<li>`: is it closed, are there warnings.
std::string verdict_items(const PageReport& report);
/// Key figures, each `<div>` with a number and what it counts.
std::string key_figures(const PageReport& report);
/// Sentences in sections, each `<section>`: what went in, the resolution, what came out, topology, errors,
/// times.
std::string report_sections(const PageReport& report);
/// Rows of a table of the deviations' figures.
std::string deviation_rows(const DeviationFigures& figures);
/// Places to look at, each `<li>` with a button that has data-place="x y z": warnings, what was dropped,
/// boundary loops, the farthest points.
std::string places_to_look(const PageReport& report, const DeviationFigures& figures);

} // namespace hsdm::command
