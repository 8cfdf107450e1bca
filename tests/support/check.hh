#pragma once
// What every mesh the project writes must be, as one sentence per fault.

#include "hsdm/polygon_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "support/solid.hh"

#include <cstring>
#include <string>
#include <vector>

namespace hsdm::support {

/// Empty if the mesh is a consistently oriented 2-manifold (possibly with boundary) without degenerate or
/// duplicate facets and isolated vertices, outward if closed; otherwise what is wrong with it.
std::string faults(const PolygonMesh& mesh);

/// Bit for bit, so that -0 is not 0.
template <class T>
bool are_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Empty if two meshes are the same to the last bit, with sharp edges and properties; otherwise what differs.
std::string difference_of_bits(const PolygonMesh& one, const PolygonMesh& other);

/// The largest distance of a vertex from the solid's boundary.
double farthest_vertex(const PolygonMesh& mesh, const Solid& solid);

/// Empty if two meshes are one, vertex by vertex up to rounding, and facet by facet in any order, all turned
/// over or none; otherwise what differs.
std::string difference_of_turned(const PolygonMesh& one, const PolygonMesh& other);

} // namespace hsdm::support
