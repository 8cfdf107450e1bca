#pragma once
// Values per vertex as named properties of an OpenMesh mesh.

#include "hsdm/mesh_types.hh"
#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// Gives vertex v of the mesh the value of `source[v]`, one for each of its vertices, in the property of that
/// name, which .om files keep; one of another type is replaced. Integers that cannot hold a value take their
/// nearest limit, 0 for what is not a number. Parallel.
void set_vertex_property(const VertexProperty& from, std::span<const Index> source, PolyMesh& mesh);

} // namespace hsdm
