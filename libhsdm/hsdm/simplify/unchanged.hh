#pragma once
// What two meshes of a sequence have in common.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Which vertices and facets of a mesh are those of a mesh before it, both ways; no_index for the others.
struct Unchanged {
    std::vector<Index> vertex, facet;         ///< per vertex and facet now, its number before
    std::vector<Index> vertex_now, facet_now; ///< per vertex and facet before, its number now
};

/// A vertex is the same if it has the same `origin` (where a mesh has none: number) and position, a facet if
/// its vertices are the same in the same order, with four and more also from the same one on (triangulate()
/// depends on that). Of facets with the same ring only the first counts. O(n), parallel in parts.
Unchanged find_unchanged(const PolygonMesh& before, const PolygonMesh& now);

} // namespace hsdm
