#pragma once
// Calls of the command, small enough to be repeated thousands of times.

#include "faults/bench.hh"

namespace hsdm::faults {

/// `reconstruct`: every output format, levels, several inputs, debugging output, both grids, streams.
std::vector<Scenario> reconstructions();
/// `info` of every format that is read, small and larger than what is read at once.
std::vector<Scenario> readings();
/// `process`, `regress`, `compare`, `info --json`.
std::vector<Scenario> other_commands();

} // namespace hsdm::faults
