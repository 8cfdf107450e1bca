#pragma once
// Solids by the names that hsdm_generate and hsdm_bench know.

#include "support/solid.hh"

#include <string>

namespace hsdm::support {

/// All names; `random` is a tree of solids that the seed chooses.
const std::vector<std::string>& solid_names();

/// `width` is that of the walls and gaps of crowded parts.
Solid solid_named(const std::string& name, std::uint64_t seed = 1, double width = 0.04);

/// Where the seed turns a solid.
Pose pose_by_seed(std::uint64_t seed);

} // namespace hsdm::support
