#pragma once
// Polygons cut into triangles: the one cut that the STL writer, the distances and the volumes share.

#include "hsdm/polygon_mesh.hh"

#include <array>
#include <vector>

namespace hsdm {

using Triangle = std::array<Index, 3>;

/// The triangles of a mesh, facet by facet, over the mesh's own vertices and oriented as their facet.
struct Triangulation {
    std::vector<Triangle> triangles;
    std::vector<Index> first{0}; ///< facet f is triangles[first[f]] .. triangles[first[f + 1]]

    std::size_t size() const { return triangles.size(); }
};

/// Every polygon of n >= 3 corners gives n - 2 triangles; fewer corners give none. A quad is cut along its
/// shorter diagonal, unless that folds its two triangles onto each other and the other diagonal does not.
/// Larger polygons lose their ear of shortest cut first, seen along their area vector; what has no ear left
/// (a polygon that crosses itself) is fanned. O(corners) for quads, parallel; no other order of facets,
/// nor number of threads, changes the cut of a facet.
Triangulation triangulate(const PolygonMesh& mesh);

/// The same of one facet, appended.
void append_triangles(const PolygonMesh& mesh, std::size_t facet, std::vector<Triangle>& triangles);

/// The facet of each triangle.
std::vector<Index> facet_of_triangle(const Triangulation& triangulation);

} // namespace hsdm
