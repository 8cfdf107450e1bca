#pragma once
// A mesh as two numbers: two builds of the library that agree in both made the same bits.

#include "hsdm/mesh_types.hh"

#include <cstdint>

namespace hsdm::test {

struct MeshHash {
    std::uint64_t geometry = 0; ///< mesh_hash(): positions, corners and sizes of facets
    std::uint64_t features = 0; ///< of the vertices' normals and properties and the sharp edges: phase 3

    bool operator==(const MeshHash&) const = default;
};

/// The same on every machine. O(corners).
MeshHash hash_of(const PolyMesh& mesh);

} // namespace hsdm::test
