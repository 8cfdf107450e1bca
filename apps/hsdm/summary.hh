#pragma once
// Reports for people.

#include "hsdm/report.hh"

#include <iosfwd>

namespace hsdm::command {

/// About six lines: the cloud, the voxels and why, the mesh, its topology, its error, the time.
void print_summary(std::ostream& out, const Report& report, const std::string& written);
/// What --verbose adds: seconds of every phase, what was rejected, memory.
void print_details(std::ostream& out, const Report& report);
/// One line, for many inputs.
void print_line(std::ostream& out, const Report& report, const std::string& written);

/// "closed, genus 3", "open, 2 boundary loops of 40 edges, genus 0".
std::string topology_words(const Report::Mesh& mesh);

/// 12345678 -> "12,345,678".
std::string grouped(std::size_t number);

} // namespace hsdm::command
