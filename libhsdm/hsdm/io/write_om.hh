#pragma once
// OpenMesh's own format: the half-edge mesh with its properties and status bits.

#include "hsdm/mesh_types.hh"

#include <string>

namespace hsdm {

/// Writes the mesh as .om, by OpenMesh's writer: points and normals in double, status bits, and every named
/// property marked persistent (`hsdm_vertex_class`, `hsdm_normal_count`, `hsdm_normals`, `hsdm_level`). The
/// same promise as write_mesh: the complete file or the old one. Throws Error.
void write_om(const std::string& path, const PolyMesh& mesh);

} // namespace hsdm
