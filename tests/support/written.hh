#pragma once
// What reconstructions of one cloud come to, to be compared.

#include "hsdm/pipeline/reconstruct_in_tiles.hh"

#include <string>

namespace hsdm::support {

/// The bytes of its PLY file.
std::string ply_of(const PolygonMesh& mesh);
std::string ply_of(const FlatReconstruction& flat);

/// Empty if two reports list the same loops, in their order; otherwise what differs.
std::string difference_of_loops(const Report& one, const Report& other);

} // namespace hsdm::support
