#pragma once
// A mesh as one number: two meshes with the same digest have the same bits.

#include "hsdm/polygon_mesh.hh"

#include <cstdint>
#include <string>

namespace hsdm {

/// Of the positions' bits, the facets' corners in their order, and their sizes: neither normals and
/// properties nor the format of a file play a part. Written as OFF, PLY, OBJ or .om and read again, a mesh
/// has the digest it had. The same on every machine; two meshes that differ share one by accident once in
/// 2^64. O(corners).
std::uint64_t mesh_hash(const PolygonMesh& mesh);
/// The same as 16 hexadecimal digits.
std::string mesh_digest(const PolygonMesh& mesh);

} // namespace hsdm
