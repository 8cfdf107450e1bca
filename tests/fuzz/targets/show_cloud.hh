#pragma once
// What a fuzzer made of its bytes, for people.

#include "hsdm/reconstruct.hh"

#include <string>

namespace hsdm::fuzz {

/// Writes the cloud as a PLY file in text, every digit, with the options in a comment as the command spells
/// them (those it does not have by their names in ReconstructOptions).
void show_cloud(const std::string& path, const PointCloud& cloud, const ReconstructOptions& options);

} // namespace hsdm::fuzz
