#pragma once
// Reports for people.

#include "hsdm/report.hh"

#include <string>

namespace hsdm::command {

/// About six lines: the cloud, the voxels and why, the mesh, its topology, its error, the time.
std::string summary_of(const Report& report, const std::string& written);
/// What --verbose adds: seconds of every phase, what was rejected, memory.
std::string details_of(const Report& report);
/// One line, for many inputs.
std::string line_of(const Report& report, const std::string& written);

/// A line for each warning, to stand last; empty if there is none.
std::string warnings_of(const Report& report);
/// Why --strict lets a report with warnings not pass.
std::string strict_words(const Report& report);

/// "closed, genus 3", "open, 2 boundary loops of 40 edges, genus 0".
std::string topology_words(const Report::Mesh& mesh);

/// Lines on what the file is other than was asked for, or does not show; empty if there is nothing to be
/// said.
std::string written_words(const Report::Written& written);

/// What the columns of a table were taken for, and what to do if that is wrong.
std::string columns_words(const std::string& columns, bool has_normals);

/// 12345678 -> "12,345,678".
std::string grouped(std::size_t number);
/// "1 edge", "2,000 edges".
std::string counted(std::size_t count, const std::string& one, const std::string& many);

/// The report's text of an option; empty if there is none.
std::string option_value(const Report& report, const std::string& name);
/// What a stage rejected; 0 if nothing was counted.
std::size_t rejected_count(const Report& report, const std::string& stage);

} // namespace hsdm::command
